"""The characters that plots are drawn with, and their width."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

WIDTH: Final = 79
"""Columns of a document on a terminal of 80."""


@dataclass(frozen=True, slots=True)
class PlotGlyphs:
    """Characters that plots are drawn with."""

    bars: tuple[str, ...]
    """Bars of the first, second and third group, distinct in shape."""
    point: str
    line: str
    encoder: str
    """What maps are drawn with."""


BLOCK_GLYPHS: Final = PlotGlyphs(bars=("█", "▒", "░"), point="o", line="·", encoder="braille")
ASCII_GLYPHS: Final = PlotGlyphs(bars=("#", "=", "-"), point="o", line=".", encoder="ascii")
