"""How each role looks: its shape, which tells it apart without colours, and its colours."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Literal

from kit.render.roles import Role
from kit.render.xterm_colors import Rgb

Color = str | int | tuple[int, int, int] | None
"""A name of the 16 ANSI colours, a number of the 256, red-green-blue, or None: what the terminal writes in."""

LineStyle = Literal["solid", "dashed", "long-dashed", "dotted", "sparse", "paired"]

LINE_DASHES: Mapping[LineStyle, tuple[int, int]] = MappingProxyType(
    {
        "solid": (1, 1),
        "dashed": (7, 4),
        "long-dashed": (12, 9),
        "dotted": (3, 1),
        "sparse": (6, 1),
        "paired": (6, 2),
    }
)
"""Dots in a period of a line, and how many of them are drawn."""


@dataclass(frozen=True, slots=True)
class RoleStyle:
    color: Color = None
    bold: bool = False
    dim: bool = False


@dataclass(frozen=True, slots=True)
class RoleLook:
    """How one role looks: its shape, which tells it apart without colours, and its colour in each palette."""

    shape: str
    """The character where one is all there is."""
    ansi: RoleStyle
    """Among the terminal's own 16 colours."""
    dark: Rgb
    light: Rgb
    contrast: Rgb
    colorblind: Rgb
    line: LineStyle = "solid"
    """How a way of this role is drawn."""


def _look(
    shape: str,
    ansi: RoleStyle,
    dark: int,
    light: int,
    contrast: int,
    colorblind: int,
    line: LineStyle = "solid",
) -> RoleLook:
    return RoleLook(shape, ansi, _rgb(dark), _rgb(light), _rgb(contrast), _rgb(colorblind), line)


def _pen(shape: str, ansi: str, color: int) -> RoleLook:
    """A colour that a pen's line can have: the same on every dark floor, darker on a light one."""
    red, green, blue = on_dark = _rgb(color)
    on_light = red * 7 // 10, green * 7 // 10, blue * 7 // 10
    return RoleLook(shape, RoleStyle(ansi), on_dark, on_light, on_dark, on_dark)


def _rgb(number: int) -> Rgb:
    return number >> 16, number >> 8 & 0xFF, number & 0xFF


DEFAULT_STYLE = RoleStyle()
_YELLOW, _BLUE, _GREEN = RoleStyle("yellow"), RoleStyle("blue"), RoleStyle("green")

# Walls are in the terminal's own foreground colour: readable on dark and on light, and without a byte of escape code.
# The last colours of each row are those of Okabe and Ito (2008) and near them, which eyes without red or green tell apart.
ROLE_LOOKS: Mapping[Role, RoleLook] = MappingProxyType(
    {
        Role.FLOOR: _look(" ", DEFAULT_STYLE, 0x1C222D, 0xFDFCF9, 0x000000, 0x1C222D),
        Role.LIT_FAR: _look(" ", DEFAULT_STYLE, 0x36352E, 0xFFF5D7, 0x20200C, 0x323330),
        Role.LIT_NEAR: _look(" ", DEFAULT_STYLE, 0x4E4832, 0xFFECB0, 0x343414, 0x484636),
        Role.BEAM: _look("`", RoleStyle("yellow", dim=True), 0x967A3C, 0xD6B060, 0xC8C800, 0x968C3C),
        Role.FIELD: _look("'", _BLUE, 0x6A92CD, 0x426CB2, 0x96BEFF, 0x0072B2),
        Role.PATH: _look("-", _BLUE, 0x6E96D2, 0x426CB2, 0x96BEFF, 0x3C8CC8),
        Role.GHOST_OTHER: _look(
            '"', RoleStyle("cyan", dim=True), 0xC8B478, 0x82681E, 0xE6D282, 0xC8BEA0, "paired"
        ),
        Role.GHOST_AGENT: _look(
            "!", RoleStyle("bright_magenta"), 0xFFA8B8, 0xCE3E68, 0xFFB4C8, 0xFFBED2, "sparse"
        ),
        Role.GHOST_PROGRAM: _look(
            "_", RoleStyle("red"), 0x60A5FA, 0x145AC8, 0x78BEFF, 0x78C8C8, "long-dashed"
        ),
        Role.GHOST_KEYS: _look("~", RoleStyle(dim=True), 0xC4C4C4, 0x686868, 0xD2D2D2, 0xE1E1EB, "dashed"),
        Role.GHOST_REFERENCE: _look(
            "=", RoleStyle("magenta", dim=True), 0xB090FF, 0x7040C8, 0xBEA0FF, 0x968CFF, "dotted"
        ),
        Role.TRAIL: _look(",", RoleStyle("cyan"), 0x4296AA, 0x549CAE, 0x00C8C8, 0x4682AA),
        Role.TRAIL_2: _look(";", RoleStyle("magenta"), 0xB0609C, 0xBE6EA8, 0xFF78FF, 0xA06E8C),
        Role.PEN_WHITE: _look(
            "w", DEFAULT_STYLE, 0xC8C8C8, 0x464646, 0xC8C8C8, 0xC8C8C8
        ),  # black ink on paper
        Role.PEN_RED: _pen("r", "red", 0xDC3C3C),
        Role.PEN_YELLOW: _pen("y", "yellow", 0xDCC83C),
        Role.PEN_GREEN: _pen("g", "green", 0x46BE5A),
        Role.PEN_CYAN: _pen("c", "cyan", 0x3CBED2),
        Role.PEN_BLUE: _pen("b", "blue", 0x5A6EE6),
        Role.PEN_MAGENTA: _pen("m", "magenta", 0xC85AC8),
        Role.WALL: _look("#", DEFAULT_STYLE, 0x8E99AC, 0x464D5C, 0xFFFFFF, 0x969EAA),
        Role.WALL_HIT: _look(":", RoleStyle("yellow", dim=True), 0xDEB264, 0xD68C34, 0xFFFF00, 0xF0E442),
        Role.BODY: _look("%", _BLUE, 0xE48C60, 0xA45424, 0xFFAA6E, 0xE69F00),
        Role.CURVE_4: _look("$", _GREEN, 0x96D66E, 0x1E7432, 0x00FF00, 0x00BC8C),
        Role.CURVE_3: _look("x", _YELLOW, 0xF4C85C, 0x965400, 0xFFFF00, 0xF0E442),
        Role.CURVE_2: _look("+", RoleStyle("magenta", bold=True), 0xFA82CD, 0xAC227C, 0xFF8CFF, 0xCC79A7),
        Role.CURVE_1: _look("*", RoleStyle("cyan", bold=True), 0x54E2F4, 0x00708C, 0x00FFFF, 0x56B4E9),
        Role.HIT: _look(".", _YELLOW, 0xFFC45C, 0xCE6800, 0xFFFF00, 0xF0E442),
        Role.TARGET: _look("o", RoleStyle("green", bold=True), 0x78DC82, 0x148038, 0x00FF00, 0x00BC8C),
        Role.ROBOT_2: _look("&", RoleStyle("magenta", bold=True), 0xFA82CD, 0xAC227C, 0xFF8CFF, 0xCC79A7),
        Role.ROBOT: _look("@", RoleStyle("cyan", bold=True), 0x54E2F4, 0x00708C, 0x00FFFF, 0x56B4E9),
        Role.CONTACT: _look("X", RoleStyle("red", bold=True), 0xFF605E, 0xC81C28, 0xFF5050, 0xE6781E),
        Role.TEXT: _look("?", RoleStyle(bold=True), 0xF0F3FA, 0x14161C, 0xFFFFFF, 0xF0F3FA),
    }
)
"""The shape and the colours of every role that is drawn."""

PEN_ROLES: Mapping[Role, Rgb] = MappingProxyType(
    {role: look.dark for role, look in ROLE_LOOKS.items() if role.name.startswith("PEN_")}
)
"""The colours that a pen's line can have in the view; any other is shown in the nearest."""


def nearest_pen_role(color: Rgb) -> Role:
    """The role in whose colour a pen's line is shown."""
    return min(
        PEN_ROLES,
        key=lambda role: sum((a - b) ** 2 for a, b in zip(PEN_ROLES[role], color, strict=True)),
    )
