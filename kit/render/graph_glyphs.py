"""The characters of a drawn graph's lines, by where they lead, and its other signs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

EAST, NORTH, WEST, SOUTH = 1, 2, 4, 8
HORIZONTAL, VERTICAL = EAST | WEST, NORTH | SOUTH


@dataclass(frozen=True, slots=True)
class LineGlyphs:
    """The characters of lines, by where they lead; and the other signs."""

    light: Mapping[int, str]
    heavy: Mapping[int, str]
    dashed: Mapping[int, str]
    arrow: str
    message: str
    mismatch: str
    ellipsis: str
    """Stands for the beginning of a name that is too long."""


def _line_table(level: str, upright: str, corners: str) -> Mapping[int, str]:
    joints = (EAST | SOUTH, WEST | SOUTH, NORTH | EAST, NORTH | WEST, VERTICAL | EAST, VERTICAL | WEST)
    tees = (*joints, HORIZONTAL | SOUTH, HORIZONTAL | NORTH, HORIZONTAL | VERTICAL)
    straight = {
        EAST: level,
        WEST: level,
        HORIZONTAL: level,
        NORTH: upright,
        SOUTH: upright,
        VERTICAL: upright,
    }
    return MappingProxyType({**straight, **dict(zip(tees, corners, strict=True))})


_LIGHT = "┌┐└┘├┤┬┴┼"

UNICODE_LINES: Final = LineGlyphs(
    _line_table("─", "│", _LIGHT),
    _line_table("━", "┃", "┏┓┗┛┣┫┳┻╋"),
    _line_table("╌", "│", _LIGHT),
    arrow="▶",
    message="●",
    mismatch="✗",
    ellipsis="…",
)

ASCII_LINES: Final = LineGlyphs(
    _line_table("-", "|", "+" * 9),
    _line_table("=", "|", "#" * 9),
    _line_table(".", "|", "+" * 9),
    arrow=">",
    message="o",
    mismatch="X",
    ellipsis="~",
)
