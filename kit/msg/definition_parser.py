"""Parses interface definitions: the texts of ``.msg``, ``.srv`` and ``.action`` files.

The rules are those of ROS 2's own parser (rosidl_adapter). Types are only split into their parts here; which
classes they stand for is decided by ``class_builder``.
"""

from __future__ import annotations

import re
from functools import lru_cache
from typing import Final, NamedTuple

SECTIONS: Final = {"msg": 1, "srv": 2, "action": 3}
"""How many sections, separated by ``---``, each kind of definition has."""

MAX_LENGTH: Final = 1_000_000
"""The largest length of a fixed array."""

_TYPE = re.compile(
    r"(?:(?P<package>[a-z]\w*)/(?:msg/)?)?(?P<name>[A-Za-z]\w*)(?:<=(?P<limit>\d{1,9}))?"
    r"(?P<array>\[(?P<bounded><=)?(?P<count>\d{0,9})\])?"
)
_LINE = re.compile(r"\s*(?P<type>\S+)\s+(?P<name>\w+)(?:\s*(?P<equals>=)|(?=\s|$))\s*(?P<value>.*?)\s*")
_FIELD_NAME = re.compile(r"[a-z][a-z0-9]*(?:_[a-z0-9]+)*")
_CONSTANT_NAME = re.compile(r"[A-Z][A-Z0-9]*(?:_[A-Z0-9]+)*")
_SINCE = re.compile(r"\s*added in (\w+)\s*")
_ROS_1_TYPES = {"time": "builtin_interfaces/Time", "duration": "builtin_interfaces/Duration"}


class DefinitionError(ValueError):
    """An interface definition cannot be read; the message names the file, the line and the column."""

    def __init__(self, file: str, line: int, column: int, problem: str) -> None:
        super().__init__(f"{file}:{line}:{column}: {problem}")


class TypeText(NamedTuple):
    """The parts of a field's type."""

    name: str
    """``float64``, ``string``, ``Point``"""
    package: str = ""
    """The package written before a slash; empty if none is."""
    limit: int | None = None
    """The largest length of a bounded string."""
    is_array: bool = False
    length: int | None = None
    """The number of items of an array of fixed length."""
    bound: int | None = None
    """The largest number of items of a bounded sequence."""


class MemberText(NamedTuple):
    """One line of a definition: a field or a constant."""

    type: TypeText
    name: str
    value: str
    """The constant's value or the field's default, as written; empty if a field has none."""
    line: int
    column: int
    value_column: int
    since: str = ""
    """The first ROS 2 distribution that has the field, from the comment ``# added in iron``."""


class SectionText(NamedTuple):
    """What stands between two separators: the members of one message."""

    fields: list[MemberText]
    constants: list[MemberText]


def parse_definition(text: str, part: str, file: str) -> list[SectionText]:
    """The sections of a definition: one of a ``msg``, two of a ``srv``, three of an ``action``.

    ``file`` is only named in messages. Raises DefinitionError.
    """
    sections = [SectionText([], [])]
    seen: set[str] = set()
    number = 0
    for number, line in enumerate(text.splitlines(), start=1):
        code, _, comment = line.partition("#")
        if not code or code.isspace():
            continue
        if code.rstrip() == "---":
            if len(sections) == SECTIONS[part]:
                raise DefinitionError(
                    file, number, 1, f"one '---' too many: a .{part} file has {SECTIONS[part]} section(s)"
                )
            sections.append(SectionText([], []))
            seen = set()
            continue
        member, is_constant = _member(code, comment, number, file)
        if member.name in seen:
            raise DefinitionError(file, number, member.column, f"the name '{member.name}' is used twice")
        seen.add(member.name)
        (sections[-1].constants if is_constant else sections[-1].fields).append(member)
    if len(sections) < SECTIONS[part]:
        raise DefinitionError(
            file, number + 1, 1, f"a .{part} file needs {SECTIONS[part]} sections, separated by lines '---'"
        )
    return sections


def _member(code: str, comment: str, number: int, file: str) -> tuple[MemberText, bool]:
    """The field or constant of a line, and whether it is a constant."""
    match = _LINE.fullmatch(code)
    start = len(code) - len(code.lstrip()) + 1
    if match is None:
        raise DefinitionError(
            file, number, start, f"needs a type and a name, as 'float64 speed', not '{code.strip()}'"
        )
    column = match.start("name") + 1
    kind = _type(match["type"])
    if isinstance(kind, str):
        raise DefinitionError(file, number, start, kind)
    name, value, is_constant = match["name"], match["value"], match["equals"] is not None
    if is_constant and not _CONSTANT_NAME.fullmatch(name):
        raise DefinitionError(
            file, number, column, f"'{name}': names of constants are upper case, as 'MAX_SPEED'"
        )
    if not is_constant and not _FIELD_NAME.fullmatch(name):
        raise DefinitionError(
            file, number, column, f"'{name}': names of fields are lower case, as 'max_speed'"
        )
    if is_constant and not value:
        raise DefinitionError(file, number, column, f"the constant '{name}' has no value")
    since = _SINCE.fullmatch(comment) if comment else None
    member = MemberText(
        kind, name, value, number, column, match.start("value") + 1, since[1] if since else ""
    )
    return member, is_constant


@lru_cache(maxsize=1024)
def _type(text: str) -> TypeText | str:
    """The parts of a type, or what is wrong with it."""
    match = _TYPE.fullmatch(text)
    if match is None:
        return f"'{text}' is not a type"
    name, count = match["name"], match["count"]
    if text in _ROS_1_TYPES:
        return f"'{text}' is a type of ROS 1; in ROS 2 write {_ROS_1_TYPES[text]}"
    if match["limit"] and name not in ("string", "wstring"):
        return f"'{text}': only strings have a largest length; a sequence is bounded by '{name}[<=N]'"
    if match["bounded"] and not count:
        return f"'{text}': a bounded sequence needs a number, as '{name}[<=10]'"
    if match["array"] and count and int(count) == 0:
        return f"'{text}': an array needs at least one item"
    if match["array"] and count and not match["bounded"] and int(count) > MAX_LENGTH:
        return f"'{text}': an array has at most {MAX_LENGTH} items here"
    return TypeText(
        name,
        match["package"] or "",
        int(match["limit"]) if match["limit"] else None,
        match["array"] is not None,
        int(count) if count and not match["bounded"] else None,
        int(count) if count and match["bounded"] else None,
    )
