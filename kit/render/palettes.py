"""Palettes that style roles: the terminal's own colours, none, and those of the themes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType

from kit.render.role_looks import DEFAULT_STYLE, ROLE_LOOKS, RoleStyle
from kit.render.roles import Role
from kit.render.xterm_colors import Rgb, nearest_xterm_color, xterm_rgb

Palette = Mapping[Role, RoleStyle]

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
        """The scheme in the nearest of xterm's 256 colours."""

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
