"""Roles of dots and characters, and the palettes that style them.

A role is a meaning, not a colour: an encoder gives it a shape, a palette gives it a style.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from enum import IntEnum
from types import MappingProxyType


class Role(IntEnum):
    """Roles in order of importance: where several meet, the highest is drawn."""

    EMPTY = 0
    FLOOR = 1
    """Where a robot can be: behind what stands there."""
    LIT = 2
    """Floor that a laser sees."""
    BEAM = 3
    FIELD = 4
    PATH = 5
    TRAIL = 6
    TRAIL_2 = 7
    PEN_WHITE = 8
    PEN_RED = 9
    PEN_YELLOW = 10
    PEN_GREEN = 11
    PEN_CYAN = 12
    PEN_BLUE = 13
    PEN_MAGENTA = 14
    WALL = 15
    WALL_HIT = 16
    """A wall where a laser's ray ends on it."""
    BODY = 17
    HIT = 18
    TARGET = 19
    ROBOT_2 = 20
    ROBOT = 21
    CONTACT = 22
    TEXT = 23


ROBOT_ROLES = (Role.ROBOT, Role.ROBOT_2)
"""The first robot's role, the second's, the third's as the first's again; their glyphs tell them apart too."""

SHADES = (Role.FLOOR, Role.LIT)
"""Roles that are only ever seen behind others."""

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
        Role.FLOOR: DEFAULT_STYLE,
        Role.LIT: DEFAULT_STYLE,
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
        Role.WALL_HIT: RoleStyle("yellow"),
        Role.BODY: RoleStyle("blue"),
        Role.HIT: RoleStyle("yellow"),
        Role.TARGET: RoleStyle("green", bold=True),
        Role.ROBOT_2: RoleStyle("magenta", bold=True),
        Role.ROBOT: RoleStyle("cyan", bold=True),
        Role.CONTACT: RoleStyle("red", bold=True),
        Role.TEXT: RoleStyle(bold=True),
    }
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

Rgb = tuple[int, int, int]


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


_PENS_ON_LIGHT = {
    role: (red * 7 // 10, green * 7 // 10, blue * 7 // 10) for role, (red, green, blue) in PEN_ROLES.items()
}

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
            roles=MappingProxyType(
                {
                    **PEN_ROLES,
                    Role.FLOOR: (28, 34, 45),
                    Role.LIT: (66, 62, 46),
                    Role.BEAM: (150, 122, 60),
                    Role.FIELD: (106, 146, 205),
                    Role.PATH: (110, 150, 210),
                    Role.TRAIL: (66, 150, 170),
                    Role.TRAIL_2: (176, 96, 156),
                    Role.WALL: (142, 153, 172),
                    Role.WALL_HIT: (222, 178, 100),
                    Role.BODY: (132, 160, 214),
                    Role.HIT: (255, 196, 92),
                    Role.TARGET: (120, 220, 130),
                    Role.ROBOT_2: (250, 130, 205),
                    Role.ROBOT: (84, 226, 244),
                    Role.CONTACT: (255, 90, 90),
                    Role.TEXT: (240, 243, 250),
                }
            ),
        ),
        "light": ColorScheme(
            dark=False,
            background=(238, 235, 227),
            foreground=(46, 50, 60),
            accent=(0, 98, 160),
            good=(10, 100, 40),
            warn=(138, 72, 0),
            bad=(186, 26, 40),
            roles=MappingProxyType(
                {
                    **_PENS_ON_LIGHT,
                    Role.FLOOR: (253, 252, 249),
                    Role.LIT: (255, 240, 196),
                    Role.BEAM: (214, 176, 96),
                    Role.FIELD: (66, 108, 178),
                    Role.PATH: (66, 108, 178),
                    Role.TRAIL: (84, 156, 174),
                    Role.TRAIL_2: (190, 110, 168),
                    Role.WALL: (70, 77, 92),
                    Role.WALL_HIT: (214, 140, 52),
                    Role.BODY: (92, 108, 150),
                    Role.HIT: (206, 104, 0),
                    Role.TARGET: (20, 128, 56),
                    Role.ROBOT_2: (172, 34, 124),
                    Role.ROBOT: (0, 112, 140),
                    Role.CONTACT: (200, 28, 40),
                    Role.TEXT: (20, 22, 28),
                }
            ),
        ),
        "contrast": ColorScheme(
            dark=True,
            background=(0, 0, 0),
            foreground=(255, 255, 255),
            accent=(255, 255, 0),
            good=(0, 255, 0),
            warn=(255, 255, 0),
            bad=(255, 120, 120),
            roles=MappingProxyType(
                {
                    **PEN_ROLES,
                    Role.FLOOR: (0, 0, 0),
                    Role.LIT: (52, 52, 20),
                    Role.BEAM: (200, 200, 0),
                    Role.FIELD: (150, 190, 255),
                    Role.PATH: (150, 190, 255),
                    Role.TRAIL: (0, 200, 200),
                    Role.TRAIL_2: (255, 120, 255),
                    Role.WALL: (255, 255, 255),
                    Role.WALL_HIT: (255, 255, 0),
                    Role.BODY: (170, 200, 255),
                    Role.HIT: (255, 255, 0),
                    Role.TARGET: (0, 255, 0),
                    Role.ROBOT_2: (255, 140, 255),
                    Role.ROBOT: (0, 255, 255),
                    Role.CONTACT: (255, 80, 80),
                    Role.TEXT: (255, 255, 255),
                }
            ),
        ),
        # The colours of Okabe and Ito (2008), which eyes without red or green tell apart.
        "colorblind": ColorScheme(
            dark=True,
            background=(13, 16, 22),
            foreground=(205, 211, 222),
            accent=(86, 180, 233),
            good=(86, 180, 233),
            warn=(240, 228, 66),
            bad=(230, 120, 30),
            roles=MappingProxyType(
                {
                    **PEN_ROLES,
                    Role.FLOOR: (28, 34, 45),
                    Role.LIT: (56, 56, 48),
                    Role.BEAM: (150, 140, 60),
                    Role.FIELD: (0, 114, 178),
                    Role.PATH: (60, 140, 200),
                    Role.TRAIL: (70, 130, 170),
                    Role.TRAIL_2: (160, 110, 140),
                    Role.WALL: (150, 158, 170),
                    Role.WALL_HIT: (240, 228, 66),
                    Role.BODY: (190, 196, 206),
                    Role.HIT: (240, 228, 66),
                    Role.TARGET: (0, 188, 140),
                    Role.ROBOT_2: (204, 121, 167),
                    Role.ROBOT: (86, 180, 233),
                    Role.CONTACT: (230, 120, 30),
                    Role.TEXT: (240, 243, 250),
                }
            ),
        ),
    }
)
"""Palettes by the user's name for them (``--theme``)."""
