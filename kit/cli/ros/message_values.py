"""Parses a message on a command line: the name of its type, and its fields in YAML."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import Any, TypeVar

import yaml

from kit.cli.ros.world_client import exit_with_error, register_workspace_interfaces
from kit.msg.builtin_interfaces import Time
from kit.msg.conversion import ConversionError, from_dict
from kit.msg.fields import MessageKind
from kit.msg.interfaces import DefinitionError, UnknownInterface
from kit.msg.message import Message
from kit.msg.std_msgs import Header

T = TypeVar("T")


class _Loader(yaml.SafeLoader):
    """A YAML loader that also reads ``1e-3`` as a number."""


_Loader.add_implicit_resolver(
    "tag:yaml.org,2002:float", re.compile(r"[-+]?[0-9]+(\.[0-9]*)?[eE][-+]?[0-9]+$"), list("-+0123456789")
)


def find_or_exit(find: Callable[[str], T], name: str) -> T:
    """The message or service class that ``find(name)`` returns; exits if there is none."""
    register_workspace_interfaces()
    try:
        return find(name)
    except (UnknownInterface, DefinitionError) as problem:
        exit_with_error(f"The passed type is invalid: {problem}")


def parse_fields(text: str) -> Mapping[str, Any]:
    """The fields in a YAML text; exits if it cannot be read."""
    try:
        content = yaml.load(text, Loader=_Loader)
    except yaml.YAMLError as problem:
        exit_with_error(f"The passed value is no YAML: {' '.join(str(problem).split())}")
    if content in (None, ""):
        return {}
    if not isinstance(content, dict):
        exit_with_error(
            "The passed value needs to be a dictionary in YAML format, such as '{linear: {x: 0.5}}'"
        )
    return content


def make_message(cls: type[Message], content: Mapping[str, Any], now_ns: int) -> Any:
    """A message with these fields; exits if they do not fit. ``auto`` for a header and ``now`` for a time: ``now_ns``."""
    try:
        return from_dict(cls, _with_timestamps(cls, content, now_ns))
    except ConversionError as problem:
        exit_with_error(f"Failed to populate field: {problem}")


def _with_timestamps(cls: type[Message], content: Mapping[str, Any], now_ns: int) -> dict[str, Any]:
    now = {"sec": now_ns // 1_000_000_000, "nanosec": now_ns % 1_000_000_000}
    kinds = {field.name: field.kind for field in cls.__ros_fields__}
    dated = dict(content)
    for name, value in content.items():
        kind = kinds.get(name)
        if not isinstance(kind, MessageKind):
            continue
        if kind.cls is Header and value == "auto":
            dated[name] = {"stamp": now}
        elif kind.cls is Time and value == "now":
            dated[name] = now
        elif isinstance(value, Mapping):
            dated[name] = _with_timestamps(kind.cls, value, now_ns)
    return dated
