"""A case in characters: its graph where that can be followed, else its matrix."""

from __future__ import annotations

from collections.abc import Collection

from kit.layers.drawing.graph import MAX_ENTITIES_IN_PICTURE, draw_graph
from kit.layers.drawing.matrix import draw_matrix
from kit.layers.drawing.spans import DrawingLine, GlyphStyle
from kit.layers.requirements import ContactRequirement, LayerCase


def draw_case(
    case: LayerCase,
    *,
    struck: Collection[ContactRequirement] = (),
    group: Collection[str] = (),
    glyphs: GlyphStyle = "braille",
) -> list[DrawingLine]:
    """The picture of a case where that can be followed, else its matrix."""
    if len(case.names) > MAX_ENTITIES_IN_PICTURE:
        return draw_matrix(case, struck=struck, group=group)
    return draw_graph(case, struck=struck, group=group, glyphs=glyphs)
