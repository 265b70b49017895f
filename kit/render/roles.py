"""Roles of dots and characters, and the palettes that style them.

A role is a meaning, not a colour: an encoder gives it a shape, a palette gives it a style.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from enum import IntEnum
from types import MappingProxyType
from typing import Literal


class Role(IntEnum):
    """Roles in order of importance: where several meet, the highest is drawn."""

    EMPTY = 0
    FLOOR = 1
    """Where a robot can be: behind what stands there."""
    LIT_FAR = 2
    """Floor that a laser sees, away from it and near it."""
    LIT_NEAR = 3
    BEAM = 4
    FIELD = 5
    PATH = 6
    GHOST_OTHER = 7
    """A former drive: a classmate's, then the agent's, the program's, the one by hand, the reference's."""
    GHOST_AGENT = 8
    GHOST_PROGRAM = 9
    GHOST_KEYS = 10
    GHOST_REFERENCE = 11
    TRAIL = 12
    TRAIL_2 = 13
    PEN_WHITE = 14
    PEN_RED = 15
    PEN_YELLOW = 16
    PEN_GREEN = 17
    PEN_CYAN = 18
    PEN_BLUE = 19
    PEN_MAGENTA = 20
    WALL = 21
    WALL_HIT = 22
    """A wall where a laser's ray ends on it."""
    BODY = 23
    """What stands or moves in the world and is no robot: a cart, a table."""
    CURVE_4 = 24
    CURVE_3 = 25
    CURVE_2 = 26
    CURVE_1 = 27
    HIT = 28
    TARGET = 29
    ROBOT_2 = 30
    ROBOT = 31
    CONTACT = 32
    TEXT = 33


ROBOT_ROLES = (Role.ROBOT, Role.ROBOT_2)
"""The first robot's role, the second's, the third's as the first's again; their glyphs tell them apart too."""

LIT_ROLES = (Role.LIT_NEAR, Role.LIT_FAR)
"""Floor that a laser sees, from the laser outwards."""

SHADES = (Role.FLOOR, *LIT_ROLES)
"""Roles that are only ever seen behind others."""

TRAIL_ROLES = (Role.TRAIL, Role.TRAIL_2)

GHOST_ROLES = (
    Role.GHOST_REFERENCE,
    Role.GHOST_KEYS,
    Role.GHOST_PROGRAM,
    Role.GHOST_AGENT,
    Role.GHOST_OTHER,
)

CURVE_ROLES = (Role.CURVE_1, Role.CURVE_2, Role.CURVE_3, Role.CURVE_4)
"""The first curve's of a plot, the second's, ..., the fifth's as the first's again; numbers and dashes tell them apart
too."""

Color = str | int | tuple[int, int, int] | None
"""A name of the 16 ANSI colours, a number of the 256, red-green-blue, or None: what the terminal writes in."""

Rgb = tuple[int, int, int]


@dataclass(frozen=True, slots=True)
class RoleStyle:
    color: Color = None
    bold: bool = False
    dim: bool = False


Palette = Mapping[Role, RoleStyle]

DEFAULT_STYLE = RoleStyle()

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
        Role.PEN_WHITE: _pen("w", "white", 0xC8C8C8),
        Role.PEN_RED: _pen("r", "red", 0xDC3C3C),
        Role.PEN_YELLOW: _pen("y", "yellow", 0xDCC83C),
        Role.PEN_GREEN: _pen("g", "green", 0x46BE5A),
        Role.PEN_CYAN: _pen("c", "cyan", 0x3CBED2),
        Role.PEN_BLUE: _pen("b", "blue", 0x5A6EE6),
        Role.PEN_MAGENTA: _pen("m", "magenta", 0xC85AC8),
        Role.WALL: _look("#", DEFAULT_STYLE, 0x8E99AC, 0x464D5C, 0xFFFFFF, 0x969EAA),
        Role.WALL_HIT: _look(":", _YELLOW, 0xDEB264, 0xD68C34, 0xFFFF00, 0xF0E442),
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


ANSI_PALETTE: Palette = MappingProxyType(
    {Role.EMPTY: DEFAULT_STYLE, **{role: look.ansi for role, look in ROLE_LOOKS.items()}}
)

MONOCHROME_PALETTE: Palette = MappingProxyType(
    {
        role: replace(style, color=None, bold=style.bold or role is Role.HIT)
        for role, style in ANSI_PALETTE.items()
    }
)
"""Shape and weight alone: what moves and what matters is bold."""

PALETTES: Mapping[str, Palette] = MappingProxyType({"none": MONOCHROME_PALETTE, "16": ANSI_PALETTE})
"""The palettes of terminals whose own colours are used, or none."""


@dataclass(frozen=True, slots=True)
class ColorScheme:
    """The colours of one theme, for terminals of 256 colours and more."""

    dark: bool
    background: Rgb
    """Background of the whole screen."""
    foreground: Rgb
    accent: Rgb
    """What is chosen, and titles."""
    good: Rgb
    warn: Rgb
    bad: Rgb
    roles: Mapping[Role, Rgb]

    def reduced(self) -> ColorScheme:
        """The same in colours that are among the 256 of xterm."""

        def near(rgb: Rgb) -> Rgb:
            return xterm_rgb(nearest_xterm_color(rgb))

        return replace(
            self,
            background=near(self.background),
            foreground=near(self.foreground),
            accent=near(self.accent),
            good=near(self.good),
            warn=near(self.warn),
            bad=near(self.bad),
            roles=MappingProxyType({role: near(rgb) for role, rgb in self.roles.items()}),
        )

    def palette(self, reduced: bool) -> Palette:
        """``reduced``: to the nearest of the 256 colours of xterm."""
        styles = {
            role: replace(ANSI_PALETTE[role], color=nearest_xterm_color(rgb) if reduced else rgb, dim=False)
            for role, rgb in self.roles.items()
        }
        return MappingProxyType({**ANSI_PALETTE, **styles})


_XTERM_LEVELS = (0, 95, 135, 175, 215, 255)
_GREYISH = 40
"""A colour whose parts differ by less is reduced to a grey: the cube has none near it but with a hue of their own."""


def nearest_xterm_color(rgb: Rgb) -> int:
    """The number, 16 to 255, of the nearest colour in xterm's cube and its row of greys."""
    greys: dict[int, Rgb] = {number: xterm_rgb(number) for number in (16, *range(232, 256), 231)}
    if max(rgb) - min(rgb) < _GREYISH:
        candidates = greys
    else:
        steps = [min(range(6), key=lambda step: abs(_XTERM_LEVELS[step] - part)) for part in rgb]
        number = 16 + 36 * steps[0] + 6 * steps[1] + steps[2]
        candidates = {number: xterm_rgb(number), **greys}

    def distance(number: int) -> int:
        return sum((a - b) ** 2 for a, b in zip(candidates[number], rgb, strict=True))

    return min(candidates, key=distance)


def xterm_rgb(number: int) -> Rgb:
    """The colour 16 to 255 of xterm's 256."""
    if number >= 232:
        level = 8 + 10 * (number - 232)
        return level, level, level
    red, rest = divmod(number - 16, 36)
    green, blue = divmod(rest, 6)
    return _XTERM_LEVELS[red], _XTERM_LEVELS[green], _XTERM_LEVELS[blue]


COLOR_SCHEMES: Mapping[str, ColorScheme] = MappingProxyType(
    {
        "dark": ColorScheme(
            dark=True,
            background=(13, 16, 22),
            foreground=(205, 211, 222),
            accent=(94, 197, 255),
            good=(120, 214, 130),
            warn=(245, 190, 90),
            bad=(255, 105, 105),
            roles=MappingProxyType({role: look.dark for role, look in ROLE_LOOKS.items()}),
        ),
        "light": ColorScheme(
            dark=False,
            background=(238, 235, 227),
            foreground=(46, 50, 60),
            accent=(0, 98, 160),
            good=(10, 100, 40),
            warn=(138, 72, 0),
            bad=(186, 26, 40),
            roles=MappingProxyType({role: look.light for role, look in ROLE_LOOKS.items()}),
        ),
        "contrast": ColorScheme(
            dark=True,
            background=(0, 0, 0),
            foreground=(255, 255, 255),
            accent=(255, 255, 0),
            good=(0, 255, 0),
            warn=(255, 255, 0),
            bad=(255, 120, 120),
            roles=MappingProxyType({role: look.contrast for role, look in ROLE_LOOKS.items()}),
        ),
        "colorblind": ColorScheme(
            dark=True,
            background=(13, 16, 22),
            foreground=(205, 211, 222),
            accent=(86, 180, 233),
            good=(86, 180, 233),
            warn=(240, 228, 66),
            bad=(230, 120, 30),
            roles=MappingProxyType({role: look.colorblind for role, look in ROLE_LOOKS.items()}),
        ),
    }
)
"""Palettes by the user's name for them (``--theme``)."""
