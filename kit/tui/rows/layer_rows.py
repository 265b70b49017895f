"""A layer plan as a picture beside words."""

from __future__ import annotations

from typing import Final

from kit.document.rows import Row, row
from kit.layers.drawing.graph import MAX_ENTITIES_IN_PICTURE, draw_graph
from kit.layers.drawing.layer_grid import draw_layer_grid
from kit.layers.drawing.spans import GlyphStyle, drawn
from kit.layers.guided_tour import TourPage
from kit.layers.requirements import LayerCase

LEAST_WORDS_BESIDE: Final = 34
"""Columns for words beside a picture."""


def words_width(width: int) -> int:
    """How many columns of a screen belong to words, the others to the picture."""
    return max(LEAST_WORDS_BESIDE, width * 7 // 16)


def picture(case: LayerCase, page: TourPage, width: int, height: int, glyphs: GlyphStyle) -> list[Row]:
    """The collision graph with what a page points at."""
    if not case.names:
        return [row(), row(("nothing to plan yet: e to edit, m for another case", "dim"))]
    if len(case.names) > MAX_ENTITIES_IN_PICTURE:
        return [row(), row((f"{len(case.names)} are too many for a picture", "dim"))]
    lines = draw_graph(
        case,
        struck=page.covered_edges,
        group=page.group,
        laser=page.laser,
        layers=page.layers,
        width=max(1, width),
        height=max(1, height),
        glyphs=glyphs,
        boxes=True,
    )
    return drawn(lines)


def layer_grid(case: LayerCase, page: TourPage, width: int, glyphs: GlyphStyle) -> list[Row]:
    """The layers that a page knows of, under a title; always as many rows for one case, or none for want of room."""
    newest = page.layers[-1].name if page.group and page.layers else None
    lines = draw_layer_grid(case, page.layers, page.watches, newest=newest, width=width, glyphs=glyphs)
    return [row(("Layers", "title")), *drawn(lines)] if lines else []
