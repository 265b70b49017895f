"""A YAML document as a tree of nodes with their locations.

Scalars stay text until a number or a boolean is requested, as in Flatland's own reader; what a plain
scalar means on its own follows the YAML 1.2 core schema (``no`` is text, ``1e-3`` a number).
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import TypeAlias

from kit.world.records import SourceLocation

_NUMBER = re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?", re.ASCII)
_INTEGER = re.compile(r"[-+]?[0-9]{1,19}", re.ASCII)
_RADIX = {"0x": 16, "0o": 8}
_NULLS = frozenset({"", "~", "null", "Null", "NULL"})
_INFINITIES = {".inf": 1.0, "+.inf": 1.0, "-.inf": -1.0}
_NANS = frozenset({".nan", ".NaN", ".NAN"})
_BOOLEANS = MappingProxyType(
    {
        spelling: flag
        for flag, words in ((True, ("true", "yes", "on", "y")), (False, ("false", "no", "off", "n")))
        for word in words
        for spelling in (word, word.capitalize(), word.upper())
    }
)
_CORE_BOOLEANS = frozenset({"true", "True", "TRUE", "false", "False", "FALSE"})


@dataclass(frozen=True, slots=True)
class ScalarNode:
    """A scalar: its text, and whether it stood in the file without quotes."""

    text: str
    is_plain: bool
    location: SourceLocation
    display_text: str | None = None
    """What messages call it, where its text is not what stands in the file: an environment variable's value
    is used but never shown."""
    is_broken: bool = False
    """It replaces a value that could not be read, which was reported: no further mistake is reported for it."""

    @property
    def height(self) -> int:
        return 0

    @property
    def is_null(self) -> bool:
        return self.is_plain and self.text in _NULLS


@dataclass(frozen=True, slots=True)
class ListNode:
    items: tuple[Node, ...]
    location: SourceLocation
    height: int
    """Nesting depth: 1 for a list of scalars."""


@dataclass(frozen=True, slots=True)
class MapNode:
    entries: Mapping[str, MapEntry]
    location: SourceLocation
    height: int
    """As of a list."""


@dataclass(frozen=True, slots=True)
class MapEntry:
    """One ``key: value`` of a mapping: where the key stands, and the value."""

    location: SourceLocation
    value: Node


Node: TypeAlias = ScalarNode | ListNode | MapNode


def parse_number(text: str) -> float | None:
    """The number that ``text`` spells (perhaps an infinity or NaN), or None."""
    if _NUMBER.fullmatch(text):
        return float(text)
    if text.lower() in _INFINITIES:
        return _INFINITIES[text.lower()] * float("inf")
    if text in _NANS:
        return float("nan")
    integer = parse_integer(text)
    return None if integer is None else float(integer)


def parse_integer(text: str) -> int | None:
    """The whole number that ``text`` spells, of at most 19 digits, or None."""
    if _INTEGER.fullmatch(text):
        return int(text)
    base = _RADIX.get(text[:2])
    if base is None or not text[2:].isalnum() or not text.isascii() or len(text) > 18:
        return None
    try:
        return int(text[2:], base)
    except ValueError:  # a digit that the base does not have
        return None


def parse_bool(text: str) -> bool | None:
    """True or False by any of the words Flatland takes (true, yes, on, y and their opposites), or None."""
    return _BOOLEANS.get(text)


def to_python(node: Node) -> object:
    """The node as plain immutable Python: None, bool, int, float, str, tuples and read-only mappings."""
    if isinstance(node, ListNode):
        return tuple(to_python(item) for item in node.items)
    if isinstance(node, MapNode):
        return MappingProxyType({key: to_python(entry.value) for key, entry in node.entries.items()})
    if not node.is_plain:
        return node.text
    if node.is_null:
        return None
    if node.text in _CORE_BOOLEANS:
        return parse_bool(node.text)
    integer = parse_integer(node.text)
    if integer is not None:
        return integer
    number = parse_number(node.text)
    return node.text if number is None else number
