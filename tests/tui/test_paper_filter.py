"""Every text in the terminal's own 16 colours can be read, on a dark and on a light background."""

from __future__ import annotations

import pytest
from rich.color import ColorSystem
from rich.segment import Segment
from rich.style import Style
from textual.color import Color

from kit.tui.paper_filter import PaperFilter
from kit.tui.widgets.text_rows import LOOKS

XTERM = (
    (0, 0, 0),
    (205, 0, 0),
    (0, 205, 0),
    (205, 205, 0),
    (0, 0, 238),
    (205, 0, 205),
    (0, 205, 205),
    (229, 229, 229),
)
"""What xterm has for the 16 colours; those of other terminals are chosen for their background."""
LEAST = 3.0
"""The contrast that WCAG 2.1 asks of large and bold text."""
WHITE = Color(255, 255, 255)


@pytest.mark.parametrize("name", LOOKS)
def test_on_a_light_background_every_look_stands_out(name: str) -> None:
    (shown,) = PaperFilter().apply([Segment("text", LOOKS[name])], WHITE)
    assert shown.text == "text"
    assert isinstance(shown.style, Style)
    assert contrast_with_white(shown.style) >= LEAST
    assert (shown.style.bold, shown.style.dim, shown.style.reverse) == (
        LOOKS[name].bold,
        LOOKS[name].dim,
        LOOKS[name].reverse,
    )


def test_without_the_filter_some_do_not() -> None:
    assert min(map(contrast_with_white, LOOKS.values())) < 2.0


def contrast_with_white(style: Style) -> float:
    if style.color is None or style.color.is_default:
        return 21.0
    number = style.color.downgrade(ColorSystem.STANDARD).number
    assert number is not None
    return 1.05 / (luminance(XTERM[number % 8]) + 0.05)


def luminance(rgb: tuple[int, int, int]) -> float:
    """As WCAG 2.1 defines it."""
    linear = (
        (part / 12.92) if part <= 0.03928 else ((part + 0.055) / 1.055) ** 2.4
        for part in (c / 255 for c in rgb)
    )
    return sum(weight * part for weight, part in zip((0.2126, 0.7152, 0.0722), linear, strict=True))
