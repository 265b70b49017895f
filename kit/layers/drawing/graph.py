"""The collision graph of a case as a picture in characters."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from functools import lru_cache
from itertools import combinations
from typing import TypeAlias

from kit.layers.assignment import NamedLayer
from kit.layers.drawing.canvas import BOX_ROWS, EntityBox, TextCanvas
from kit.layers.drawing.spans import STYLE_RANK, DrawingLine, DrawingStyle, GlyphStyle
from kit.layers.requirements import ContactRequirement, LayerCase

MAX_ENTITIES_IN_PICTURE = 16
"""With more entities than this, lines cross too often to follow: draw the matrix."""
NAME_PLACES = (0.5, 0.42, 0.58, 0.34, 0.66, 0.27, 0.73)
"""Where along an edge its layers may be named, as shares of its length, the best first."""
EntityLabel: TypeAlias = tuple[str, DrawingStyle]


def draw_graph(
    case: LayerCase,
    *,
    struck: Collection[ContactRequirement] = (),
    group: Collection[str] = (),
    laser: str | None = None,
    wrong: Collection[ContactRequirement] = (),
    cursor: str | None = None,
    layers: Sequence[NamedLayer] = (),
    width: int = 80,
    height: int = 17,
    glyphs: GlyphStyle = "braille",
    boxes: bool = False,
) -> list[DrawingLine]:
    """The collision graph as a picture of ``width`` x ``height`` characters.

    Edges are lines; a struck one is faint dashes; one inside the ``group`` is drawn thick, and the names of the
    group stand in ``[ ]``. Maps stand between ``# #``. A ``laser``, in ``< >``, sends a dotted beam to everything
    it must see. ``wrong``: pairs that collide and must not, as lines of their own. ``cursor``: a name that stands out.
    ``layers``: an edge bears the names of those that hold both its ends, where they have room.
    ``boxes``: where no two would touch, each name stands in a box that says what it is.
    """
    names = [*_reduce_crossings(case), *([laser] if laser else [])]
    canvas = TextCanvas(width, height, glyphs)
    edges = {edge: _edge_style(edge, struck, group) for edge in case.edges()}
    lines = sorted((edges | dict.fromkeys(wrong, "wrong")).items(), key=lambda each: STYLE_RANK[each[1]])
    labels = {name: _entity_label(case, name, group) for name in names}
    if boxes and (placed := _place_boxes(case, labels, laser, cursor, width, height)):
        _draw_boxed_graph(canvas, case, placed, lines, laser)
        _name_edges(canvas, layers, edges, {name: box.middle for name, box in placed.items()})
        return canvas.lines()
    positions = dict(zip(names, _ellipse_points(len(case.names), width, height), strict=False))
    if laser:
        positions[laser] = ((width - 1) / 2, (height - 1) / 2)
        for name in sorted(case.laser[laser].sees):
            canvas.line(positions[laser], positions[name], "beam")
    for edge, style in lines:
        canvas.line(positions[edge.a], positions[edge.b], style)
    for name, (label, style) in labels.items():
        canvas.label(positions[name], label, "cursor" if name == cursor else style)
    _name_edges(canvas, layers, edges, positions)
    return canvas.lines()


def _place_boxes(
    case: LayerCase,
    labels: Mapping[str, EntityLabel],
    laser: str | None,
    cursor: str | None,
    width: int,
    height: int,
) -> dict[str, EntityBox] | None:
    """A box for every name on an ellipse that grows with their number; None where two boxes would touch."""
    count = len(case.names)
    widest = max(map(len, labels), default=0) + 6  # a label is two columns wider than its name
    across = min((width - widest - 1) / 2, 20.0 + 8 * count)
    down = min((height - 1 - BOX_ROWS) / 2, 6.0 + 3 * count)
    if across <= 0 or down <= 0:
        return None
    first = math.pi if count == 2 else -math.pi / 2
    middle = (width - 1) // 2, (height - 2) // 2 + 0.5  # a box of four rows has its middle between two
    placed: dict[str, EntityBox] = {}
    for i, (name, (label, style)) in enumerate(labels.items()):
        turn = first + math.tau * i / max(count, 1)
        x, y = middle[0] + across * math.cos(turn), middle[1] + math.floor(down * math.sin(turn) + 0.5)
        if name == laser:  # in the middle, but not on the only edge
            x, y = middle[0], middle[1] + (math.floor(down) if count == 2 else 0)
        is_map = name != laser and case.by_name[name].kind == "map"
        kind = "laser" if name == laser else "map" if is_map else "body"
        placed[name] = EntityBox((x, y), label, kind, style, name == cursor)
    apart = not any(one.touches(other) for one, other in combinations(placed.values(), 2))
    return placed if apart else None


def _draw_boxed_graph(
    canvas: TextCanvas,
    case: LayerCase,
    placed: Mapping[str, EntityBox],
    lines: Sequence[tuple[ContactRequirement, DrawingStyle]],
    laser: str | None,
) -> None:
    for edge, style in lines:
        canvas.line(placed[edge.a].middle, placed[edge.b].middle, style)
    seen = sorted(case.laser[laser].sees) if laser else []
    for name in seen:
        canvas.line(placed[laser or ""].middle, placed[name].middle, "beam")
    for box in placed.values():
        canvas.box(box)
    for name in seen:
        canvas.arrow(placed[laser or ""], placed[name])


def _name_edges(
    canvas: TextCanvas,
    layers: Sequence[NamedLayer],
    edges: Collection[ContactRequirement],
    positions: Mapping[str, tuple[float, float]],
) -> None:
    """Writes at each edge which layers hold both its ends, as near its middle as no other word stands."""
    for edge in edges:
        held = " ".join(layer.name for layer in layers if layer.members.issuperset((edge.a, edge.b)))
        (x0, y0), (x1, y1) = positions[edge.a], positions[edge.b]
        for share in NAME_PLACES if held else ():
            middle = x0 + (x1 - x0) * share, y0 + (y1 - y0) * share
            if canvas.is_free_of_words(middle, f" {held} "):
                canvas.label(middle, f" {held} ", "layer")
                break


def _edge_style(
    edge: ContactRequirement, struck: Collection[ContactRequirement], group: Collection[str]
) -> DrawingStyle:
    if edge.a in group and edge.b in group:
        return "group edge"
    return "struck" if edge in struck else "edge"


def _entity_label(case: LayerCase, name: str, group: Collection[str]) -> EntityLabel:
    entity = case.by_name.get(name)
    is_map = entity is not None and entity.kind == "map"
    style: DrawingStyle = "laser" if entity is None else "map" if is_map else "body"
    ends = "<>" if entity is None else "##" if is_map else "  "
    if name in group:
        ends, style = "[]", "group"
    return f"{ends[0]}{name}{ends[1]}", style


def _ellipse_points(count: int, width: int, height: int) -> list[tuple[float, float]]:
    """Points on an ellipse as wide and high as the picture, from the top clockwise: (column, row)."""
    turns = [math.tau * i / max(count, 1) - math.pi / 2 for i in range(count)]
    across, down = max(1.0, (width - 1) / 2 - 6), (height - 1) / 2
    return [((width - 1) / 2 + across * math.cos(t), down + down * math.sin(t)) for t in turns]


@lru_cache(maxsize=8)
def _reduce_crossings(case: LayerCase) -> tuple[str, ...]:
    """The entities around the ellipse, two swapped as long as that makes fewer edges cross."""
    order = list(case.names)
    edges = [(edge.a, edge.b) for edge in case.edges()]
    if len(order) > MAX_ENTITIES_IN_PICTURE:
        return tuple(order)
    best = _crossing_cost(order, edges)
    improved = True
    while improved and best > (0, 0):
        improved = False
        for i, j in combinations(range(len(order)), 2):
            order[i], order[j] = order[j], order[i]
            crossings = _crossing_cost(order, edges)
            if crossings < best:
                best, improved = crossings, True
            else:
                order[i], order[j] = order[j], order[i]
    return tuple(order)


def _crossing_cost(order: Sequence[str], edges: Sequence[tuple[str, str]]) -> tuple[int, int]:
    """Returns the number of crossing pairs of chords and the total length of the chords (in steps around the circle)."""
    place = {name: i for i, name in enumerate(order)}
    chords = [tuple(sorted((place[a], place[b]))) for a, b in edges]
    crossing = sum(a < c < b < d or c < a < d < b for (a, b), (c, d) in combinations(chords, 2))
    return crossing, sum(min(b - a, len(order) - b + a) for a, b in chords)
