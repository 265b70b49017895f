"""What a dot or a character of the picture stands for, and the ink it is drawn with.

A role is a meaning, not a colour: an encoder gives it a shape, a palette gives it an ink.
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
    WALL = 6
    BODY = 7
    HIT = 8
    TARGET = 9
    ROBOT_2 = 10
    ROBOT = 11
    CONTACT = 12
    TEXT = 13


ROBOTS = (Role.ROBOT, Role.ROBOT_2)
"""The first robot's role, the second's, the third's as the first's again; their glyphs tell them apart too."""

TRAILS = (Role.TRAIL, Role.TRAIL_2)

Color = str | int | tuple[int, int, int] | None
"""A name of the 16 ANSI colours, a number of the 256, red-green-blue, or None: what the terminal writes in."""


@dataclass(frozen=True, slots=True)
class Ink:
    color: Color = None
    bold: bool = False
    dim: bool = False


Palette = Mapping[Role, Ink]

PLAIN = Ink()

# Walls are in the terminal's own ink: readable on dark and on light, and without a byte of escape code.
ANSI: Palette = MappingProxyType(
    {
        Role.EMPTY: PLAIN,
        Role.BEAM: Ink("yellow", dim=True),
        Role.FIELD: Ink("blue"),
        Role.PATH: Ink("blue"),
        Role.TRAIL: Ink("cyan"),
        Role.TRAIL_2: Ink("magenta"),
        Role.WALL: PLAIN,
        Role.BODY: Ink("blue"),
        Role.HIT: Ink("yellow"),
        Role.TARGET: Ink("green", bold=True),
        Role.ROBOT_2: Ink("magenta", bold=True),
        Role.ROBOT: Ink("cyan", bold=True),
        Role.CONTACT: Ink("red", bold=True),
        Role.TEXT: Ink(bold=True),
    }
)

XTERM: Palette = MappingProxyType(
    {
        **ANSI,
        Role.BEAM: Ink(94),
        Role.FIELD: Ink(67),
        Role.PATH: Ink(67),
        Role.TRAIL: Ink(37),
        Role.TRAIL_2: Ink(132),
        Role.BODY: Ink(68),
        Role.HIT: Ink(214),
        Role.TARGET: Ink(77, bold=True),
        Role.ROBOT_2: Ink(205, bold=True),
        Role.ROBOT: Ink(44, bold=True),
        Role.CONTACT: Ink(196, bold=True),
    }
)

TRUECOLOR: Palette = MappingProxyType(
    {
        **ANSI,
        Role.BEAM: Ink((122, 98, 48)),
        Role.FIELD: Ink((94, 129, 172)),
        Role.PATH: Ink((94, 129, 172)),
        Role.TRAIL: Ink((52, 152, 170)),
        Role.TRAIL_2: Ink((176, 96, 156)),
        Role.BODY: Ink((108, 142, 191)),
        Role.HIT: Ink((240, 170, 60)),
        Role.TARGET: Ink((96, 200, 110), bold=True),
        Role.ROBOT_2: Ink((240, 110, 190), bold=True),
        Role.ROBOT: Ink((64, 214, 232), bold=True),
        Role.CONTACT: Ink((240, 70, 70), bold=True),
    }
)

NO_COLOR: Palette = MappingProxyType(
    {role: replace(ink, color=None, bold=ink.bold or role is Role.HIT) for role, ink in ANSI.items()}
)
"""Shape and weight alone: what moves and what matters is bold."""

PALETTES: Mapping[str, Palette] = MappingProxyType(
    {"none": NO_COLOR, "16": ANSI, "256": XTERM, "truecolor": TRUECOLOR}
)
"""By what the terminal can show."""
