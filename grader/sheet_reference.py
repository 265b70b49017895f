"""The reference of ``assignment.yaml``: every key that its reader asks for, with type, default, meaning and an example.

Types, bounds and defaults are not written here: they are what the reader asks for. So the reference cannot say anything else
than the reader does.
"""

from __future__ import annotations

import ast
import inspect
import textwrap
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from itertools import zip_longest
from pathlib import Path
from typing import Final

import yaml

from grader.evidence_digest import ASSIGNMENT_FILE, YAML_LOADER
from grader.kinds.contract import find_kind
from grader.new_assignment import example_of_kind
from grader.reading import SECRET_FILE, read_sheet
from grader.sheet_keys import COMMON_KEYS
from kit.world.key_table import OWN_NAME, FormatKey, format_keys
from kit.world.yaml_section import Section

SECRET: Final = "secret"
"""Stands before the keys of the secret file."""
LONGEST_EXAMPLE: Final = 40


@dataclass(frozen=True, slots=True)
class SheetKey:
    """One key of a sheet with what it means."""

    key: FormatKey
    path: str
    """Where it stands: ``checks.points``; entries of a list are not marked."""
    meaning: str
    example: str
    """As it stands in an example of the kind; may be empty."""


@cache
def asked_keys(kind: str) -> Mapping[str, FormatKey]:
    """Returns the keys that the reader asks for in a sheet of this kind, by path; those of the secret file begin with
    ``secret``. Without the parameters of checks, which `grader checks` lists."""
    folder = example_of_kind(kind).folders[0]  # of its files alone: what its sheet says is not read

    def read(section: Section) -> None:
        section.name("kind", "controller")
        read_sheet(kind, section, section.section(SECRET), folder)

    keys = format_keys(read, {"trials[].name": (OWN_NAME,)})
    found = {each.key.replace("[]", ""): each for each in keys}
    return {
        path: key for path, key in found.items() if path != SECRET and not path.startswith("checks.with.")
    }


def sheet_keys(kind: str) -> tuple[SheetKey, ...]:
    """Returns the keys of a kind's sheets, in the order of their meanings: those of all kinds, then its own.

    Raises FileNotFoundError if the lessons are not installed.
    """
    asked = asked_keys(kind)
    folder = example_of_kind(kind).folders[0]
    sheet, secret = (_nodes(folder / name) for name in (ASSIGNMENT_FILE, SECRET_FILE))
    words = {**COMMON_KEYS, **find_kind(kind).sheet_keys}
    return tuple(
        SheetKey(
            asked[path],
            path,
            text,
            _written_at(secret, path.split(".")[1:])
            if path.startswith(f"{SECRET}.")
            else _written_at(sheet, path.split(".")),
        )
        for path, text in words.items()
        if path in asked
    )


def _nodes(file: Path) -> yaml.Node | None:
    return yaml.compose(file.read_text(encoding="utf-8"), Loader=YAML_LOADER) if file.exists() else None


def _written_at(node: yaml.Node | None, path: list[str]) -> str:
    """What stands at a path of a sheet for the first time; empty where nothing does, or something longer."""
    if isinstance(node, yaml.SequenceNode):
        return next(filter(None, (_written_at(each, path) for each in node.value)), "")
    if not path:
        text = " ".join(node.value.split()) if isinstance(node, yaml.ScalarNode) else ""
        return text if len(text) <= LONGEST_EXAMPLE else ""
    if not isinstance(node, yaml.MappingNode):
        return ""
    parts = (value for key, value in node.value if path[0] in (key.value, OWN_NAME))
    return next(filter(None, (_written_at(each, path[1:]) for each in parts)), "")


def documented_attributes(record: type) -> Iterator[tuple[str, str]]:
    """Yields the fields and properties of a class that have a docstring, with it, in the order in which they are written."""
    (tree,) = ast.parse(textwrap.dedent(inspect.getsource(record))).body
    assert isinstance(tree, ast.ClassDef)  # the source of a class
    for node, after in zip_longest(tree.body, tree.body[1:]):
        if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            yield (
                node.target.id,
                f"{_docstring_line(_text_of(after))} ({ast.unparse(node.annotation)})".strip(),
            )
        elif isinstance(node, ast.FunctionDef) and node.decorator_list and (told := ast.get_docstring(node)):
            yield node.name, _docstring_line(told)


def _docstring_line(docstring: str) -> str:
    """A docstring in one line, with code between single backticks as in the kit's texts."""
    return " ".join(docstring.split()).replace("``", "`")


def _text_of(node: ast.stmt | None) -> str:
    """The docstring that stands as a statement; empty if the statement is none."""
    if (
        isinstance(node, ast.Expr)
        and isinstance(node.value, ast.Constant)
        and isinstance(node.value.value, str)
    ):
        return node.value.value
    return ""
