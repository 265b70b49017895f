"""A case and its plan in characters: the collision graph as a picture or a matrix, the assignment as a table.

Every line is a row of spans, a text and what it stands for: a face may colour them by their style, and joined
they are the picture in plain characters, in which no meaning hangs on colour.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations, groupby
from typing import Final, Literal

from kit.document.blocks import CellStyle, Column, Table
from kit.layers.assignment import LayerAssignment, NamedLayer
from kit.layers.requirements import ContactRequirement, LayerCase

DrawingStyle = Literal[
    "space", "edge", "struck", "group edge", "beam", "map", "body", "group", "laser", "text", "cursor"
]
GlyphStyle = Literal["braille", "ascii"]


@dataclass(frozen=True, slots=True)
class DrawingSpan:
    text: str
    style: DrawingStyle


DrawingLine = tuple[DrawingSpan, ...]

_STYLE_ORDER: Final[tuple[DrawingStyle, ...]] = (
    "space", "struck", "beam", "edge", "group edge", "text", "map", "body", "laser", "group",
    "cursor",
)  # fmt: skip
"""Where two items meet in one character, the later style is shown."""

_STYLE_RANK: Final = {style: rank for rank, style in enumerate(_STYLE_ORDER)}

MAX_ENTITIES_IN_PICTURE = 16
"""With more entities than this, lines cross too often to follow: draw the matrix."""


def to_plain_lines(lines: Iterable[DrawingLine]) -> list[str]:
    """The lines as text, without what trails behind."""
    return ["".join(span.text for span in line).rstrip() for line in lines]


def draw_graph(
    case: LayerCase,
    *,
    struck: Collection[ContactRequirement] = (),
    group: Collection[str] = (),
    laser: str | None = None,
    width: int = 80,
    height: int = 17,
    glyphs: GlyphStyle = "braille",
    boxes: bool = False,
) -> list[DrawingLine]:
    """The collision graph as a picture of ``width`` x ``height`` characters.

    Edges are lines; a struck one is faint dots; one inside the ``group`` is drawn thick, and the names of the
    group stand in ``[ ]``. Maps stand between ``# #``. A ``laser``, in ``< >``, sends a dotted beam to everything
    it must see. ``boxes``: where no two would touch, each name stands in a box that says what it is.
    """
    names = [*_reduce_crossings(case), *([laser] if laser else [])]
    canvas = _TextCanvas(width, height, glyphs)
    if boxes and (placed := _place_boxes(case, names, group, laser, width, height)):
        _draw_boxed_graph(canvas, case, placed, struck, group, laser)
        return canvas.lines()
    positions = dict(zip(names, _ellipse_points(len(case.names), width, height), strict=False))
    if laser:
        positions[laser] = ((width - 1) / 2, (height - 1) / 2)
        for name in sorted(case.laser[laser].sees):
            canvas.line(positions[laser], positions[name], "beam")
    for edge in sorted(case.edges(), key=lambda e: _STYLE_RANK[_edge_style(e, struck, group)]):
        canvas.line(positions[edge.a], positions[edge.b], _edge_style(edge, struck, group))
    for name in names:
        canvas.label(positions[name], *_entity_label(case, name, group))
    return canvas.lines()


@dataclass(frozen=True, slots=True)
class _EntityBox:
    """A name and what it is, in a box of four rows around ``middle`` (column, row)."""

    middle: tuple[float, float]
    label: str
    kind: str
    style: DrawingStyle

    @property
    def width(self) -> int:
        return max(len(self.label), len(self.kind)) + 4

    @property
    def corner(self) -> tuple[int, int]:
        """Column and row of the character at the top left."""
        return round(self.middle[0] - (self.width - 1) / 2), round(self.middle[1] - (_BOX_ROWS - 1) / 2)

    def touches(self, other: _EntityBox) -> bool:
        """Whether fewer than two columns or one row lie between the boxes."""
        across, down = abs(self.corner[0] - other.corner[0]), abs(self.corner[1] - other.corner[1])
        widest = self.width if self.corner[0] <= other.corner[0] else other.width
        return across < widest + 2 and down < _BOX_ROWS + 1


_BOX_ROWS: Final = 4


def _place_boxes(
    case: LayerCase,
    names: Sequence[str],
    group: Collection[str],
    laser: str | None,
    width: int,
    height: int,
) -> dict[str, _EntityBox] | None:
    """A box for every name on an ellipse that grows with their number; None where two boxes would touch."""
    count = len(case.names)
    widest = max((len(_entity_label(case, name, names)[0]) for name in names), default=0) + 4
    across = min((width - widest - 1) / 2, 20.0 + 8 * count)
    down = min((height - 1 - _BOX_ROWS) / 2, 6.0 + 3 * count)
    if across <= 0 or down <= 0:
        return None
    first = math.pi if count == 2 else -math.pi / 2
    middle = (width - 1) // 2, (height - 2) // 2 + 0.5  # a box of four rows has its middle between two
    placed: dict[str, _EntityBox] = {}
    for i, name in enumerate(names):
        turn = first + math.tau * i / max(count, 1)
        x, y = middle[0] + across * math.cos(turn), middle[1] + math.floor(down * math.sin(turn) + 0.5)
        if name == laser:  # in the middle, but not on the only edge
            x, y = middle[0], middle[1] + (math.floor(down) if count == 2 else 0)
        label, style = _entity_label(case, name, group)
        is_map = name != laser and case.by_name[name].kind == "map"
        kind = "laser" if name == laser else "map" if is_map else "body"
        placed[name] = _EntityBox((x, y), label, kind, style)
    apart = not any(one.touches(other) for one, other in combinations(placed.values(), 2))
    return placed if apart else None


def _draw_boxed_graph(
    canvas: _TextCanvas,
    case: LayerCase,
    placed: Mapping[str, _EntityBox],
    struck: Collection[ContactRequirement],
    group: Collection[str],
    laser: str | None,
) -> None:
    for edge in sorted(case.edges(), key=lambda e: _STYLE_RANK[_edge_style(e, struck, group)]):
        canvas.line(placed[edge.a].middle, placed[edge.b].middle, _edge_style(edge, struck, group))
    seen = sorted(case.laser[laser].sees) if laser else []
    for name in seen:
        canvas.line(placed[laser or ""].middle, placed[name].middle, "beam")
    for box in placed.values():
        canvas.box(box)
    for name in seen:
        canvas.arrow(placed[laser or ""], placed[name])


def _edge_style(
    edge: ContactRequirement, struck: Collection[ContactRequirement], group: Collection[str]
) -> DrawingStyle:
    if edge.a in group and edge.b in group:
        return "group edge"
    return "struck" if edge in struck else "edge"


def _entity_label(case: LayerCase, name: str, group: Collection[str]) -> tuple[str, DrawingStyle]:
    if name in group:
        return f"[{name}]", "group"
    entity = case.by_name.get(name)
    if entity is None:
        return f"<{name}>", "laser"
    return (f"#{name}#", "map") if entity.kind == "map" else (f" {name} ", "body")


def _ellipse_points(count: int, width: int, height: int) -> list[tuple[float, float]]:
    """Points on an ellipse as wide and high as the picture, from the top clockwise: (column, row)."""
    turns = [math.tau * i / max(count, 1) - math.pi / 2 for i in range(count)]
    across, down = max(1.0, (width - 1) / 2 - 6), (height - 1) / 2
    return [((width - 1) / 2 + across * math.cos(t), down + down * math.sin(t)) for t in turns]


def _reduce_crossings(case: LayerCase) -> list[str]:
    """The entities around the ellipse, two swapped as long as that makes fewer edges cross."""
    order = list(case.names)
    edges = [(edge.a, edge.b) for edge in case.edges()]
    if len(order) > MAX_ENTITIES_IN_PICTURE:
        return order
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
    return order


def _crossing_cost(order: Sequence[str], edges: Sequence[tuple[str, str]]) -> tuple[int, int]:
    """Returns the number of crossing pairs of chords and the total length of the chords (in steps around the circle)."""
    place = {name: i for i, name in enumerate(order)}
    chords = [tuple(sorted((place[a], place[b]))) for a, b in edges]
    crossing = sum(a < c < b < d or c < a < d < b for (a, b), (c, d) in combinations(chords, 2))
    return crossing, sum(min(b - a, len(order) - b + a) for a, b in chords)


class _TextCanvas:
    """A grid of characters with lines under labels. Columns and rows from 0, at the top left."""

    def __init__(self, width: int, height: int, glyphs: GlyphStyle) -> None:
        self._width, self._height, self._glyphs = width, height, glyphs
        self._dots: dict[tuple[int, int], int] = {}
        self._styles: dict[tuple[int, int], DrawingStyle] = {}
        self._letters: dict[tuple[int, int], str] = {}

    def line(self, start: tuple[float, float], end: tuple[float, float], style: DrawingStyle) -> None:
        """A straight line between two characters' middles."""
        draw = self._braille if self._glyphs == "braille" else self._ascii
        draw(start, end, style)

    def label(self, middle: tuple[float, float], text: str, style: DrawingStyle) -> None:
        """Text over whatever is there, moved so that it fits."""
        row = min(max(round(middle[1]), 0), self._height - 1)
        shown = text[: self._width]
        first = min(max(round(middle[0] - (len(shown) - 1) / 2), 0), self._width - len(shown))
        for i, letter in enumerate(shown):
            self._letters[first + i, row] = letter
            self._styles[first + i, row] = style

    def box(self, box: _EntityBox) -> None:
        """A frame over whatever is there: thick around the group, double around a map."""
        is_ascii = self._glyphs == "ascii"
        across, down, corners = _FRAMES.get(box.style if box.style == "group" else box.kind, _FRAMES["body"])
        if is_ascii:
            across, down, corners = _ASCII_FRAMES.get(box.style, _ASCII_FRAMES["body"])
        inner = box.width - 2
        left, top = box.corner
        rows = (
            corners[0] + across * inner + corners[1],
            f"{down}{box.label:^{inner}}{down}",
            f"{down}{box.kind:^{inner}}{down}",
            corners[2] + across * inner + corners[3],
        )
        for number, text in enumerate(rows):
            for i, letter in enumerate(text):
                self._letters[left + i, top + number] = letter
                inside = number == 2 and 0 < i < box.width - 1
                self._styles[left + i, top + number] = "text" if inside else box.style

    def arrow(self, start: _EntityBox, end: _EntityBox) -> None:
        """The head of an arrow where a line from one box meets another's frame."""
        across, down = end.middle[0] - start.middle[0], end.middle[1] - start.middle[1]
        sides = (end.width / 2 + 0.6) / abs(across) if across else math.inf
        ends = (_BOX_ROWS / 2 + 0.1) / abs(down) if down else math.inf
        share = 1 - min(sides, ends)
        signs = "<>^v" if self._glyphs == "ascii" else "←→↑↓"
        sign = signs[int(across > 0)] if sides < ends else signs[2 + int(down > 0)]
        cell = round(start.middle[0] + across * share), round(start.middle[1] + down * share)
        self._letters[cell], self._styles[cell] = sign, "beam"

    def lines(self) -> list[DrawingLine]:
        return [
            tuple(
                DrawingSpan("".join(glyph for glyph, _ in run), style)
                for style, run in groupby(
                    (self._cell(column, row) for column in range(self._width)), lambda c: c[1]
                )
            )
            for row in range(self._height)
        ]

    def _cell(self, column: int, row: int) -> tuple[str, DrawingStyle]:
        cell = column, row
        if cell in self._letters:
            return self._letters[cell], self._styles[cell]
        if cell in self._dots:
            return chr(0x2800 + self._dots[cell]), self._styles[cell]
        return " ", "space"

    def _mark(self, cell: tuple[int, int], style: DrawingStyle) -> None:
        if _STYLE_RANK[style] >= _STYLE_RANK[self._styles.get(cell, "space")]:
            self._styles[cell] = style

    def _braille(self, start: tuple[float, float], end: tuple[float, float], style: DrawingStyle) -> None:
        x0, y0, x1, y1 = (2 * start[0] + 0.5, 4 * start[1] + 1.5, 2 * end[0] + 0.5, 4 * end[1] + 1.5)
        steps = max(1, math.ceil(max(abs(x1 - x0), abs(y1 - y0))))
        every = {"struck": 6, "beam": 3}.get(style, 1)
        aside = (1, 0) if abs(y1 - y0) > abs(x1 - x0) else (0, 1)
        for step in range(0, steps + 1, every):
            x, y = round(x0 + (x1 - x0) * step / steps), round(y0 + (y1 - y0) * step / steps)
            self._dot(x, y, style)
            if style == "group edge":
                self._dot(x + aside[0], y + aside[1], style)

    def _dot(self, x: int, y: int, style: DrawingStyle) -> None:
        cell = x // 2, y // 4
        if 0 <= cell[0] < self._width and 0 <= cell[1] < self._height:
            self._dots[cell] = self._dots.get(cell, 0) | _BRAILLE[y % 4][x % 2]
            self._mark(cell, style)

    def _ascii(self, start: tuple[float, float], end: tuple[float, float], style: DrawingStyle) -> None:
        (x0, y0), (x1, y1) = start, end
        steps = max(1, math.ceil(max(abs(x1 - x0), abs(y1 - y0))))
        letter = {"struck": ".", "beam": ":", "group edge": "*"}.get(style) or _line_character(
            x1 - x0, y1 - y0
        )
        for step in range(0, steps + 1, 2 if style == "struck" else 1):
            cell = round(x0 + (x1 - x0) * step / steps), round(y0 + (y1 - y0) * step / steps)
            if _STYLE_RANK[style] >= _STYLE_RANK[self._styles.get(cell, "space")]:
                self._letters[cell] = letter
                self._mark(cell, style)


_FRAMES: Final = {
    "body": ("─", "│", "┌┐└┘"),
    "laser": ("─", "│", "┌┐└┘"),
    "map": ("═", "║", "╔╗╚╝"),
    "group": ("━", "┃", "┏┓┗┛"),
}
"""Across, down and the four corners of a box."""
_ASCII_FRAMES: Final = {
    "body": ("-", "|", "++++"),
    "map": ("=", "|", "####"),
    "group": ("#", "#", "####"),
}

_BRAILLE: Final = ((0x01, 0x08), (0x02, 0x10), (0x04, 0x20), (0x40, 0x80))
"""The bit of each dot of a braille character, by row and column."""


def _line_character(across: float, down: float) -> str:
    """The character that looks most like a line in this direction; a character is twice as high as wide."""
    if abs(down) * 5 < abs(across):
        return "-"
    if abs(across) * 1.25 < abs(down):
        return "|"
    return "\\" if (across > 0) == (down > 0) else "/"


def draw_matrix(
    case: LayerCase,
    *,
    struck: Collection[ContactRequirement] = (),
    group: Collection[str] = (),
    cursor: tuple[int, int] | None = None,
) -> list[DrawingLine]:
    """Every pair and every laser in one table, which no number of entities tangles.

    ``#`` must collide, ``x`` the same and struck, ``~`` left open, ``.`` must not; in a laser's row ``#`` must
    see, ``~`` may, ``.`` must not. A name in the ``group`` is marked by ``*``. ``cursor``: row and column of a mark
    that is to stand out; the lasers' rows follow the entities'.
    """
    numbers = [f"{i + 1}" for i in range(len(case.names))]
    digits = max((len(number) for number in numbers), default=1)
    wide = max((len(name) for name in (*case.names, *case.laser)), default=0)
    wide = min(wide, max(8, 76 - digits - 2 * len(numbers)))
    step = 2 if digits == 1 or wide + digits + 2 * len(numbers) <= 76 else 1
    lines: list[DrawingLine] = []
    for place in range(digits):
        head = "".join(number.rjust(digits)[place].ljust(step) for number in numbers)
        lines.append((DrawingSpan(" " * (wide + digits + 3) + head, "text"),))
    at_row, at_column = cursor or (None, None)
    for i, a in enumerate(case.names):
        label = f"{numbers[i].rjust(digits)}{'*' if a in group else ' '}{a[:wide].ljust(wide)}  "
        marks = [_pair_mark(case, a, b, struck) for b in case.names[: i + 1]]
        style: DrawingStyle = "group" if a in group else "map" if case.by_name[a].kind == "map" else "body"
        lines.append(
            (DrawingSpan(label, style), *_mark_spans(marks, "edge", step, at_column if i == at_row else None))
        )
    for i, laser in enumerate(case.lasers, start=len(case.names)):
        marks = [{"sees": "#", "either": "~", "blind": "."}[laser.sighting(name)] for name in case.names]
        label = f"{' ' * digits}>{laser.name[:wide].ljust(wide)}  "
        lines.append(
            (
                DrawingSpan(label, "laser"),
                *_mark_spans(marks, "beam", step, at_column if i == at_row else None),
            )
        )
    return lines


def _mark_spans(marks: Sequence[str], style: DrawingStyle, step: int, cursor: int | None) -> DrawingLine:
    """A row of the matrix, ``step`` characters to each mark, the one at the cursor apart."""
    text = "".join(mark.ljust(step) for mark in marks)
    if cursor is None:
        return (DrawingSpan(text, style),)
    at = cursor * step
    return DrawingSpan(text[:at], style), DrawingSpan(text[at], "cursor"), DrawingSpan(text[at + 1 :], style)


def _pair_mark(case: LayerCase, a: str, b: str, struck: Collection[ContactRequirement]) -> str:
    relation = case.relation(a, b)
    if a == b:
        return {"collide": "#", "apart": ".", "either": "\\"}[relation]
    if relation == "collide" and ContactRequirement(a, b) in struck:
        return "x"
    return {"collide": "#", "apart": ".", "either": "~"}[relation]


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
                DrawingSpan(f"{layer.name:<{step}}", "group" if layer.name == newest else "text")
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


def assignment_tables(case: LayerCase, assignment: LayerAssignment) -> list[Table]:
    """The plan: what each layer holds and who watches it; which list each entity and laser gets."""
    watchers = {
        layer.name: ", ".join(name for name, watched in assignment.watches.items() if layer.name in watched)
        for layer in assignment.layers
    }
    in_order = {name: i for i, name in enumerate(case.names)}
    layers = [
        (
            layer.name,
            ", ".join(sorted(layer.members, key=lambda n: in_order.get(n, -1))),
            watchers[layer.name] or "-",
        )
        for layer in assignment.layers
    ]
    none = "(none: layers: [])"
    lists = [(name, ", ".join(assignment.layers_of(name)) or none) for name in case.names]
    lasers = [(name, ", ".join(assignment.watches.get(name, ())) or none) for name in case.laser]
    tables = [
        _text_table(("layer", "holds", "watched by"), layers),
        _text_table(("who", "its layers"), lists),
        _text_table(("laser", "watches"), lasers),
    ]
    return [each for each in tables if each.rows or each is not tables[-1]]


def _text_table(heads: tuple[str, ...], rows: Sequence[tuple[str, ...]]) -> Table:
    columns = tuple(Column(head, CellStyle.TEXT) for head in heads)
    return Table("assignment", "", columns, tuple(rows), is_ruled=False)
