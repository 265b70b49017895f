"""Expands directives in scalars of world files: includes and environment variables.

Flatland also evaluates Lua after ``$eval``. That is refused, but for the forms that run no code: a call of
``env()`` by itself.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace

from kit.plain_text import quoted
from kit.world.yaml_tree import ScalarNode, parse_bool, parse_number

_INCLUDE = re.compile(r"\$(?P<spread>\[include\]|include)\s+(?P<file>\S.*)", re.DOTALL)
_EVAL = re.compile(r"\$eval\b\s*(return\b)?\s*", re.DOTALL)
_CALL = re.compile(r"(?P<function>env|param)\s*\((?P<arguments>.*)\)", re.DOTALL)
_ARGUMENT = r"""(?:\s*"([^"]*)"\s*|\s*'([^']*)'\s*|([^"',()]*))"""
_ARGUMENTS = re.compile(f"{_ARGUMENT}(,{_ARGUMENT})?")


@dataclass(frozen=True, slots=True)
class IncludeDirective:
    """``$include file``, or with ``spread`` ``$[include] file``: its documents as entries of a list."""

    file: str
    is_list: bool


class RefusedDirective(Exception):
    """A directive that is not carried out; the message says why and what to write instead."""


def expand_directive(leaf: ScalarNode, environment: Mapping[str, str]) -> ScalarNode | IncludeDirective:
    """The leaf, or what it stands for. Raises Refused."""
    text = leaf.text.strip()
    if include := _INCLUDE.fullmatch(text):
        return IncludeDirective(include["file"].strip(), include["spread"] != "include")
    prefix = _EVAL.match(text)
    call = _CALL.fullmatch(text[prefix.end() :] if prefix else text)
    if call and call["function"] == "param":
        raise RefusedDirective(
            "param() asks a ROS parameter server, and there is none here: write the value itself"
        )
    if call and (arguments := _ARGUMENTS.fullmatch(call["arguments"])):
        return _from_environment(leaf, arguments, environment)
    if call or prefix:
        raise RefusedDirective(
            "$eval runs Lua code, and a world file must not run code: write the value itself, "
            'or env("NAME", default) for an environment variable'
        )
    if text.startswith(("$include", "$[include]")):
        raise RefusedDirective('no file to include is named: write "$include file.yaml"')
    return leaf


def _from_environment(
    leaf: ScalarNode, arguments: re.Match[str], environment: Mapping[str, str]
) -> ScalarNode:
    """The variable's value; if there is none the default; if there is none, as in Flatland, an empty text."""
    name = _argument_text(arguments, 1)
    if not name:
        raise RefusedDirective('env() needs the name of an environment variable: env("NAME", default)')
    if name in environment:
        return _with_text(leaf, environment[name], f"the value of the environment variable {quoted(name)}")
    if arguments[4] is not None:
        return _with_text(leaf, _argument_text(arguments, 5), None)
    return _with_text(leaf, "", f"nothing: the environment variable {quoted(name)} is not given")


def _argument_text(arguments: re.Match[str], first: int) -> str:
    """The text of an argument that one of three groups holds: in either kind of quotes, or in none."""
    double, single, bare = arguments.group(first, first + 1, first + 2)
    return next((text for text in (double, single) if text is not None), (bare or "").strip())


def _with_text(leaf: ScalarNode, text: str, shown_as: str | None) -> ScalarNode:
    """The leaf with another text, which is a number, true or false where it spells one."""
    plain = parse_number(text) is not None or parse_bool(text) is not None
    return replace(leaf, text=text, is_plain=plain, display_text=shown_as)
