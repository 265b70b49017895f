"""Lines of text whose parts say what they stand for: a face may colour them, and joined they are plain characters."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final, Literal

from kit.document.rows import PLAIN, Row

DrawingStyle = Literal[
    "space",
    "edge",
    "struck",
    "group edge",
    "wrong",
    "beam",
    "layer",
    "map",
    "body",
    "group",
    "laser",
    "text",
    "cursor",
]


GlyphStyle = Literal["braille", "ascii"]


@dataclass(frozen=True, slots=True)
class DrawingSpan:
    text: str
    style: DrawingStyle


DrawingLine = tuple[DrawingSpan, ...]


_STYLE_ORDER: Final[tuple[DrawingStyle, ...]] = (
    "space", "struck", "beam", "edge", "group edge", "wrong", "layer", "text", "map", "body", "laser", "group",
    "cursor",
)  # fmt: skip
"""Where two items meet in one character, the later style is shown."""


STYLE_RANK: Final = {style: rank for rank, style in enumerate(_STYLE_ORDER)}


_LOOKS: Final = MappingProxyType(
    {
        "struck": "dim",
        "group edge": "good",
        "group": "good",
        "wrong": "bad",
        "beam": "warn",
        "layer": "title",
        "laser": "warn",
        "cursor": "key",
    }
)
"""How the parts of a picture are written; each has a shape of its own too."""


def drawn(lines: Iterable[DrawingLine]) -> list[Row]:
    """A drawing as rows with tones."""
    return [tuple((span.text, _LOOKS.get(span.style, PLAIN)) for span in line) for line in lines]


def to_plain_lines(lines: Iterable[DrawingLine]) -> list[str]:
    """The lines as text, without what trails behind."""
    return ["".join(span.text for span in line).rstrip() for line in lines]
