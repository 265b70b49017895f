"""Tells which strokes on a sheet are walls for sure, and which may be rules, folds, writing, measures or slips of the pen.

Walls are drawn with one pen. So what is much paler or thinner than most, small, or outside of the outer wall is doubtful: it is
left out, shown, and may be kept.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

import numpy as np

from kit.arrays import BoolArray, FloatArray
from kit.mapmaking.pixels import grown, nearest_odd
from kit.world.connected_parts import connected_parts

PALE: Final = 0.5
"""A stroke less deep than this share of the walls' is doubtful."""
THIN: Final = 0.72
"""And one narrower than this share of theirs."""
SMALL: Final = 0.075
"""And a piece apart from all others whose box has a shorter diagonal than this share of the sheet's width: writing, slips."""
LOW: Final = 0.05
"""And one whose box is lower or narrower than this, and holds more strokes than a line along it: a word."""
CROWDED: Final = 1.3
"""How many times the length of its box the strokes of a word are long."""
SOLID: Final = 0.7
"""And how many times a piece of a wall's stroke is at least, drawn with the walls' pen."""
WIDEST_ARROW: Final = 5.0
"""How many times the pen's width a measure's arrows are wide at most."""
LEAST: Final = 0.02
"""Less than this share of the sheet's width is no reason to doubt."""
ENCLOSED: Final = 0.002
"""A room without a door has at least this share of the sheet's area."""


DOUBTS: Final[Mapping[str, str]] = MappingProxyType(
    {
        "pale": "pale lines: rules of the paper, folds or shadows",
        "outside": "lines beyond the outer wall",
        "small": "small pieces: writing or loose strokes",
        "thin": "thin lines: measures or writing",
    }
)
"""Kinds of strokes that may be no walls, and what each is, in a few words."""


@dataclass(frozen=True, slots=True, eq=False)
class Doubt:
    """Strokes of one kind that may be no walls."""

    kind: str
    """Of ``DOUBTS``."""
    strokes: BoolArray
    """(rows, columns)"""

    @property
    def text(self) -> str:
        return DOUBTS[self.kind]

    def boxes(self) -> list[tuple[int, int, int, int]]:
        """Left, top, right and bottom [pixels] of its pieces, the largest first."""
        found = _boxes(connected_parts(self.strokes, across_corners=True)).values()
        ordered = sorted(found, key=lambda box: -box.diagonal)
        return [(box.left, box.top, box.left + box.width, box.top + box.height) for box in ordered]


@dataclass(frozen=True, slots=True, eq=False)
class JudgedStrokes:
    """The strokes of a sheet."""

    walls: BoolArray
    """(rows, columns) those that are walls for sure, or were said to be."""
    doubts: tuple[Doubt, ...] = ()
    """Those that may be something else, by kind."""
    notes: tuple[str, ...] = ()
    """What is strange about the walls themselves, each in a few words."""

    @property
    def remarks(self) -> tuple[str, ...]:
        """All that is doubtful or strange, each in a few words."""
        return (*(each.text for each in self.doubts), *self.notes)

    @property
    def doubtful(self) -> BoolArray:
        """(rows, columns) all strokes that may be something else."""
        return union(self.walls.shape, (each.strokes for each in self.doubts))

    def keeping(self, kinds: Collection[str]) -> JudgedStrokes:
        """A copy with the doubtful strokes of these kinds taken for walls."""
        kept = union(self.walls.shape, (each.strokes for each in self.doubts if each.kind in kinds))
        left = tuple(each for each in self.doubts if each.kind not in kinds)
        return JudgedStrokes(self.walls | kept, left, self.notes)


def union(shape: tuple[int, ...], masks: Iterable[BoolArray]) -> BoolArray:
    """Where any of the masks is true."""
    found = np.zeros(shape, dtype=np.bool_)
    for each in masks:
        found |= each
    return found


def usual_depth(depth: FloatArray, mask: BoolArray) -> float:
    """How deep the deepest strokes of a mask are: the share of the paper's light that they take."""
    return float(np.percentile(depth[mask], 93.0)) if mask.any() else 0.0


def judge_strokes(everything: BoolArray, breaks: BoolArray, deep: BoolArray) -> JudgedStrokes:
    """Judges strokes (rows, columns). ``breaks``: which of them fill a break; ``deep``: those that are not pale."""
    found: dict[str, BoolArray] = {}
    walls = everything
    pale = everything & ~grown(deep, 9)
    if _extent(pale) >= LEAST * everything.shape[1] and deep.any():
        walls = deep
        found["pale"] = pale
    parts = connected_parts(walls, across_corners=True)
    boxes = _boxes(parts)
    if not boxes:
        return JudgedStrokes(walls, tuple(Doubt(kind, mask) for kind, mask in found.items()))
    main = max(boxes, key=lambda number: boxes[number].diagonal)
    pen = _pen_width(parts == main)
    for number, kind in _doubtful_parts(parts, boxes, main, pen, _reached_from_edge(walls)):
        found[kind] = found.get(kind, np.zeros_like(walls)) | (parts == number)
    measures = _joined_measures(walls, breaks, pen)
    if measures.any():
        found["thin"] = found.get("thin", np.zeros_like(walls)) | measures
    kept = walls & ~union(walls.shape, (mask for kind, mask in found.items() if kind != "pale"))
    beyond = _outer_spurs(kept, pen)
    if _extent(beyond) >= LEAST * walls.shape[1]:
        trimmed = _remove_parts(kept, beyond)
        found["outside"] = found.get("outside", np.zeros_like(walls)) | (kept & ~trimmed)
        kept = trimmed
    notes = []
    if _extent(_thin_bits(kept, pen)) >= 2.0 * LEAST * walls.shape[1]:
        notes.append("thin lines at the walls, which are kept: folds or rules")
    rooms = _closed_rooms(kept)
    if rooms:
        notes.append("a room without a door" if rooms == 1 else f"{rooms} rooms without a door")
    near = grown(kept, 5)
    doubts = tuple(Doubt(kind, mask & ~near) for kind, mask in found.items())
    return JudgedStrokes(kept, doubts, tuple(notes))


@dataclass(frozen=True, slots=True)
class _Box:
    """The upright box around a part, in pixels."""

    width: int
    height: int
    pixels: int
    row: int
    column: int
    """A pixel of the part."""
    left: int
    top: int

    @property
    def diagonal(self) -> float:
        return float(np.hypot(self.width, self.height))


def _boxes(parts: np.ndarray) -> dict[int, _Box]:
    rows, columns = np.nonzero(parts)
    numbers = parts[rows, columns]
    found = {}
    order = np.argsort(numbers, kind="stable")
    cuts = np.flatnonzero(np.diff(numbers[order])) + 1
    for chunk in np.split(order, cuts) if len(order) else ():
        r, c = rows[chunk], columns[chunk]
        found[int(numbers[chunk[0]])] = _Box(
            int(np.ptp(c)) + 1,
            int(np.ptp(r)) + 1,
            len(chunk),
            int(r[0]),
            int(c[0]),
            int(c.min()),
            int(r.min()),
        )
    return found


def _doubtful_parts(
    parts: np.ndarray, boxes: dict[int, _Box], main: int, pen: float, outside: BoolArray
) -> Iterator[tuple[int, str]]:
    width = parts.shape[1]
    near_outside = grown(outside, 3)
    small = {number for number, box in boxes.items() if _is_small(box, width, pen)}
    near_strokes = grown(
        np.isin(parts, [number for number in boxes if number not in small]), 2 * round(pen) + 1
    )
    for number, box in boxes.items():
        if number == main:
            continue
        own = box.pixels / max(1.0, box.diagonal)
        is_rest = SOLID * pen < own < CROWDED * pen and near_strokes[parts == number].any()
        if near_outside[box.row, box.column]:
            yield number, "outside"
        elif number in small:
            if not is_rest:  # of a stroke, beyond a break that is shorter than the pen is wide
                yield number, "small"
        elif _has_arrows(parts, number, box, pen) or (own < THIN * pen and pen - own > 1.0):
            yield number, "thin"


def _joined_measures(walls: BoolArray, breaks: BoolArray, pen: float) -> BoolArray:
    """Lines with arrows that a filled break joins to the wall at which they point, with what fills it."""
    parts = connected_parts(walls & ~breaks, across_corners=True)
    arrows = [
        number
        for number, box in _boxes(parts).items()
        if not _is_small(box, walls.shape[1], pen) and _has_arrows(parts, number, box, pen)
    ]
    found = np.isin(parts, arrows)
    fillings = connected_parts(walls & breaks, across_corners=True)
    return found | np.isin(fillings, np.setdiff1d(fillings[grown(found, 3)], [0]))


def _is_small(box: _Box, width: int, pen: float) -> bool:
    """Whether a part is a short one, or a word."""
    is_crowded = box.pixels / pen > CROWDED * box.diagonal
    return box.diagonal < SMALL * width or (min(box.width, box.height) < LOW * width and is_crowded)


def _has_arrows(parts: np.ndarray, number: int, box: _Box, pen: float) -> bool:
    """Whether a straight line along the sheet's edges is wider at both ends than between them, as a measure is."""
    piece = parts[box.top : box.top + box.height, box.left : box.left + box.width] == number
    if box.height > box.width:
        piece = piece.T
    rows, columns = piece.shape
    if columns < 5 * rows or rows > WIDEST_ARROW * pen:
        return False
    extent = rows - piece.argmax(axis=0) - piece[::-1].argmax(axis=0)
    end = max(3, columns // 6)
    middle = float(np.median(extent[end:-end]))
    tips = (float(extent[:end].max()), float(extent[-end:].max()))
    return middle <= 1.5 * pen and min(tips) > 1.8 * middle


def _pen_width(mask: BoolArray) -> float:
    """The usual width of strokes [pixels]: the median of runs along rows and columns, of which a stroke has its own across it."""
    runs = []
    for lines in (mask, mask.T):
        edges = np.diff(np.pad(lines, ((0, 0), (1, 1))).astype(np.int8), axis=1)
        starts, stops = np.nonzero(edges == 1)[1], np.nonzero(edges == -1)[1]
        runs.append(stops - starts)
    return float(np.median(np.concatenate(runs)))


def _reached_from_edge(walls: BoolArray) -> BoolArray:
    """What can be reached from the sheet's edge without crossing a wall."""
    free = connected_parts(np.pad(~walls, 1, constant_values=True))
    return np.asarray((free == free[0, 0])[1:-1, 1:-1])


def _outer_spurs(walls: BoolArray, pen: float) -> BoolArray:
    """Parts of walls that only touch the outside: no outer wall, which has an inside."""
    inside = ~walls & ~_reached_from_edge(walls)
    if not inside.any():
        return np.zeros_like(walls)
    return walls & ~grown(inside, nearest_odd(3.0 * pen) + 2)


def _thin_bits(walls: BoolArray, pen: float) -> BoolArray:
    """Parts of strokes in which a pen of less than ``THIN`` of the walls' width would not fit."""
    size = 2 * int((THIN * pen - 1.0) / 2.0) + 1
    if size < 5:  # a hand's own unevenness
        return np.zeros_like(walls)
    opened = grown(~grown(~walls, size), size)
    return walls & ~grown(opened, size + 4)


def _remove_parts(walls: BoolArray, bits: BoolArray) -> BoolArray:
    """The walls without these bits and what is left of them alone."""
    kept = walls & ~bits
    parts = connected_parts(kept, across_corners=True)
    boxes = _boxes(parts)
    for number, box in boxes.items():
        if box.diagonal < SMALL * walls.shape[1]:
            kept &= parts != number
    return kept


def _closed_rooms(walls: BoolArray) -> int:
    """How many rooms there are besides the largest that nobody can enter."""
    free = connected_parts(~walls)
    sizes = np.bincount(free.ravel())
    sizes[0] = 0
    border = np.unique(np.concatenate([free[0], free[-1], free[:, 0], free[:, -1]]))
    sizes[border] = 0
    return max(0, int((sizes > ENCLOSED * walls.size).sum()) - 1)


def _extent(mask: BoolArray) -> float:
    """The longest diagonal of a part's box [pixels]."""
    boxes = _boxes(connected_parts(mask, across_corners=True))
    return max((box.diagonal for box in boxes.values()), default=0.0)
