"""The appearance of the kit in this terminal: what was decided, with the glyphs and colours for it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Self

from kit.render.palettes import COLOR_SCHEMES, PALETTES, ColorScheme
from kit.render.role_looks import RoleStyle
from kit.render.roles import Role
from kit.render.xterm_colors import Rgb
from kit.tui.terminal import TerminalDecision

if TYPE_CHECKING:
    from rich.terminal_theme import TerminalTheme
    from textual.theme import Theme as TextualTheme

    from kit.layers.drawing.spans import GlyphStyle
    from kit.render.encode import Encoder


@dataclass(frozen=True)
class Theme:
    terminal: TerminalDecision
    palette: dict[Role, RoleStyle]
    """Changed in place when another theme is chosen: whoever draws keeps this very record."""

    @classmethod
    def of(cls, terminal: TerminalDecision) -> Self:
        """The look that the decision means."""
        colour = terminal.colour.value
        if terminal.ansi:
            return cls(terminal, dict(PALETTES["none" if colour == "none" else "16"]))
        return cls(terminal, dict(COLOR_SCHEMES[terminal.theme_name.value].palette(colour == "256")))

    @property
    def graph_glyphs(self) -> GlyphStyle:
        """The characters of drawings of layers."""
        return "ascii" if self.terminal.glyphs.value == "ascii" else "braille"

    @cached_property
    def encoder(self) -> Encoder:
        """Makes dots characters. Imported by the first picture: the first frame has none."""
        from kit.render.encode import ENCODERS, BrailleEncoder

        if not self.terminal.ansi and self.terminal.glyphs.value == "braille":
            return BrailleEncoder(layers=True)
        return ENCODERS[self.terminal.glyphs.value](self.terminal.colour.value == "none")


def textual_theme(name: str, scheme: ColorScheme) -> TextualTheme:
    """Textual's own record of a theme: dialogs, lists and text areas take their colours from it."""
    from textual.theme import Theme as TextualTheme

    return TextualTheme(
        name=f"kit-{name}",
        primary=_hex(scheme.accent),
        secondary=_hex(scheme.accent),
        accent=_hex(scheme.accent),
        foreground=_hex(scheme.foreground),
        background=_hex(scheme.background),
        surface=_hex(_between(scheme.background, scheme.foreground, 0.06)),
        panel=_hex(_between(scheme.background, scheme.foreground, 0.12)),
        success=_hex(scheme.good),
        warning=_hex(scheme.warn),
        error=_hex(scheme.bad),
        dark=scheme.dark,
    )


def text_colors(scheme: ColorScheme) -> TerminalTheme:
    """The theme's colours under the names of the 16: texts are written in those names everywhere."""
    from rich.terminal_theme import TerminalTheme

    muted = _between(scheme.background, scheme.foreground, 0.5)
    hues = (scheme.bad, scheme.good, scheme.warn, scheme.accent, scheme.accent, scheme.accent)
    colors = [muted, *hues, scheme.foreground]
    return TerminalTheme(scheme.background, scheme.foreground, colors, colors)


def _between(one: Rgb, other: Rgb, share: float) -> Rgb:
    red, green, blue = (round(a + (b - a) * share) for a, b in zip(one, other, strict=True))
    return red, green, blue


def _hex(color: Rgb) -> str:
    return "#{:02x}{:02x}{:02x}".format(*color)
