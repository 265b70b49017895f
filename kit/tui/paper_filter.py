"""The 16 colours of a terminal on a light background: those that can hardly be read on white become dark ones."""

from __future__ import annotations

from functools import lru_cache
from types import MappingProxyType
from typing import Final

from rich.color import Color as RichColor
from rich.color import ColorSystem
from rich.segment import Segment
from rich.style import Style
from textual.color import Color
from textual.filter import LineFilter

DARK: Final = MappingProxyType({2: "blue", 3: "magenta", 6: "blue"})
"""By their numbers: green, yellow and cyan, of which xterm's have a contrast with white of 2 and less. Green and cyan are one
colour then: no text means anything by its colour alone."""


class PaperFilter(LineFilter):
    """Texts in dark colours alone. A picture of a world has its own palette, and is drawn without it."""

    def apply(self, segments: list[Segment], background: Color) -> list[Segment]:
        return [
            Segment(text, None if style is None else dark_on_paper(style), control)
            for text, style, control in segments
        ]


@lru_cache(1024)
def dark_on_paper(style: Style) -> Style:
    """A style with a dark colour in place of a light one.

    >>> dark_on_paper(Style(color="yellow", bold=True)) == Style(color="magenta", bold=True)
    True
    >>> dark_on_paper(Style(color="red")) == Style(color="red")
    True
    """
    color = style.color
    if color is None or color.is_default:
        return style
    number = color.downgrade(ColorSystem.STANDARD).number
    dark = None if number is None else DARK.get(number % 8)
    return style if dark is None else style + Style(color=RichColor.parse(dark))
