"""Roles of dots and characters, and the palettes that style them.

A role is a meaning, not a colour: an encoder gives it a shape, a palette gives it a style.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from enum import IntEnum
from types import MappingProxyType


class Role(IntEnum):
    """In the order of importance: where several meet, the highest is seen."""

    EMPTY = 0
    BEAM = 1
    FIELD = 2
    PATH = 3
    TRAIL = 4
    TRAIL_2 = 5
    PEN_WHITE = 6
    PEN_RED = 7
    PEN_YELLOW = 8
    PEN_GREEN = 9
    PEN_CYAN = 10
    PEN_BLUE = 11
    PEN_MAGENTA = 12
    WALL = 13
    BODY = 14
    HIT = 15
    TARGET = 16
    ROBOT_2 = 17
    ROBOT = 18
    CONTACT = 19
    TEXT = 20


ROBOT_ROLES = (Role.ROBOT, Role.ROBOT_2)
"""The first robot's role, the second's, the third's as the first's again; their glyphs tell them apart too."""

TRAIL_ROLES = (Role.TRAIL, Role.TRAIL_2)

PEN_ROLES: Mapping[Role, tuple[int, int, int]] = MappingProxyType(
    {
        Role.PEN_WHITE: (200, 200, 200),
        Role.PEN_RED: (220, 60, 60),
        Role.PEN_YELLOW: (220, 200, 60),
        Role.PEN_GREEN: (70, 190, 90),
        Role.PEN_CYAN: (60, 190, 210),
        Role.PEN_BLUE: (90, 110, 230),
        Role.PEN_MAGENTA: (200, 90, 200),
    }
)
"""The colours that a pen's line can have in the view; any other is shown in the nearest."""


def nearest_pen_role(color: tuple[int, int, int]) -> Role:
    """The role in whose colour a pen's line is shown."""
    return min(
        PEN_ROLES,
        key=lambda role: sum((a - b) ** 2 for a, b in zip(PEN_ROLES[role], color, strict=True)),
    )


Color = str | int | tuple[int, int, int] | None
"""A name of the 16 ANSI colours, a number of the 256, red-green-blue, or None: what the terminal writes in."""


@dataclass(frozen=True, slots=True)
class RoleStyle:
    color: Color = None
    bold: bool = False
    dim: bool = False


Palette = Mapping[Role, RoleStyle]

DEFAULT_STYLE = RoleStyle()

# Walls are in the terminal's own foreground colour: readable on dark and on light, and without a byte of escape code.
ANSI_PALETTE: Palette = MappingProxyType(
    {
        Role.EMPTY: DEFAULT_STYLE,
        Role.BEAM: RoleStyle("yellow", dim=True),
        Role.FIELD: RoleStyle("blue"),
        Role.PATH: RoleStyle("blue"),
        Role.TRAIL: RoleStyle("cyan"),
        Role.TRAIL_2: RoleStyle("magenta"),
        Role.PEN_WHITE: RoleStyle("white"),
        Role.PEN_RED: RoleStyle("red"),
        Role.PEN_YELLOW: RoleStyle("yellow"),
        Role.PEN_GREEN: RoleStyle("green"),
        Role.PEN_CYAN: RoleStyle("cyan"),
        Role.PEN_BLUE: RoleStyle("blue"),
        Role.PEN_MAGENTA: RoleStyle("magenta"),
        Role.WALL: DEFAULT_STYLE,
        Role.BODY: RoleStyle("blue"),
        Role.HIT: RoleStyle("yellow"),
        Role.TARGET: RoleStyle("green", bold=True),
        Role.ROBOT_2: RoleStyle("magenta", bold=True),
        Role.ROBOT: RoleStyle("cyan", bold=True),
        Role.CONTACT: RoleStyle("red", bold=True),
        Role.TEXT: RoleStyle(bold=True),
    }
)

XTERM_PALETTE: Palette = MappingProxyType(
    {
        **ANSI_PALETTE,
        Role.BEAM: RoleStyle(94),
        Role.FIELD: RoleStyle(67),
        Role.PATH: RoleStyle(67),
        Role.TRAIL: RoleStyle(37),
        Role.TRAIL_2: RoleStyle(132),
        Role.BODY: RoleStyle(68),
        Role.HIT: RoleStyle(214),
        Role.TARGET: RoleStyle(77, bold=True),
        Role.ROBOT_2: RoleStyle(205, bold=True),
        Role.ROBOT: RoleStyle(44, bold=True),
        Role.CONTACT: RoleStyle(196, bold=True),
    }
)

TRUECOLOR_PALETTE: Palette = MappingProxyType(
    {
        **ANSI_PALETTE,
        **{role: RoleStyle(color) for role, color in PEN_ROLES.items()},
        Role.BEAM: RoleStyle((122, 98, 48)),
        Role.FIELD: RoleStyle((94, 129, 172)),
        Role.PATH: RoleStyle((94, 129, 172)),
        Role.TRAIL: RoleStyle((52, 152, 170)),
        Role.TRAIL_2: RoleStyle((176, 96, 156)),
        Role.BODY: RoleStyle((108, 142, 191)),
        Role.HIT: RoleStyle((240, 170, 60)),
        Role.TARGET: RoleStyle((96, 200, 110), bold=True),
        Role.ROBOT_2: RoleStyle((240, 110, 190), bold=True),
        Role.ROBOT: RoleStyle((64, 214, 232), bold=True),
        Role.CONTACT: RoleStyle((240, 70, 70), bold=True),
    }
)

MONOCHROME_PALETTE: Palette = MappingProxyType(
    {
        role: replace(style, color=None, bold=style.bold or role is Role.HIT)
        for role, style in ANSI_PALETTE.items()
    }
)
"""Shape and weight alone: what moves and what matters is bold."""

PALETTES: Mapping[str, Palette] = MappingProxyType(
    {"none": MONOCHROME_PALETTE, "16": ANSI_PALETTE, "256": XTERM_PALETTE, "truecolor": TRUECOLOR_PALETTE}
)
"""By what the terminal can show."""
