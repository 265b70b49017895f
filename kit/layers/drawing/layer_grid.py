"""A grid of marks: the bodies in each layer, and the lasers that look at it."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

from kit.layers.assignment import NamedLayer
from kit.layers.drawing.spans import DrawingLine, DrawingSpan, DrawingStyle, GlyphStyle
from kit.layers.requirements import LayerCase


def draw_layer_grid(
    case: LayerCase,
    layers: Sequence[NamedLayer],
    watches: Mapping[str, Collection[str]],
    *,
    newest: str | None = None,
    width: int = 80,
    glyphs: GlyphStyle = "braille",
) -> list[DrawingLine]:
    """Draws which entity is in which layer, one column each, and which laser watches it; the column of the ``newest`` stands out.

    Always as many lines, however many layers there are. No lines where the columns are too many for ``width``.
    """
    holds, watched, absent = ("#", "o", ".") if glyphs == "ascii" else ("●", "○", "·")
    names = [*case.names, *case.laser]
    wide = max(len(name) for name in names) if names else 0
    step = max((len(layer.name) for layer in layers), default=0) + 2
    if wide + 2 + step * len(layers) > width:
        return []
    head = f"{'':{wide}}  " if layers else "No layer yet"
    lines: list[DrawingLine] = [
        (
            DrawingSpan(head, "text"),
            *(
                DrawingSpan(f"{layer.name:<{step}}", "group" if layer.name == newest else "layer")
                for layer in layers
            ),
        )
    ]
    for name in names:
        is_laser = name in case.laser
        style: DrawingStyle = "laser" if is_laser else "map" if case.by_name[name].kind == "map" else "body"
        spans = [DrawingSpan(f"{name:{wide}}  ", style)]
        for layer in layers:
            is_in = layer.name in watches.get(name, ()) if is_laser else name in layer.members
            mark = (watched if is_laser else holds) if is_in else absent
            look: DrawingStyle = "group" if is_in and layer.name == newest else "text" if is_in else "struck"
            spans.append(DrawingSpan(f"{mark:<{step}}", look))
        lines.append(tuple(spans))
    legend = f"{holds} in the layer" + (f"   {watched} watches it" if case.laser else "")
    return [*lines, (DrawingSpan(legend[:width], "struck"),)]
