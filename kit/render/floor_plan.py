"""A small picture of a map as text: the floor that can be reached, with the walls around it, and places as signs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import product
from typing import Final

import numpy as np

from kit.arrays import BoolArray, FloatArray, IntArray
from kit.render.camera import Camera
from kit.render.scene import Scene

SAMPLES: Final = 4
"""Of a quarter of a character, along each side."""
SHARES: Final = (0.9, 0.75, 0.6, 0.45, 0.3, 0.15)
"""Of a quarter that has to be floor to be drawn so: the first one with which all places are still connected, so that walls are
drawn as far as they leave every way open."""
QUARTERS: Final = " ▘▝▀▖▌▞▛▗▚▐▜▄▙▟█"
"""A character by which of its quarters are wall: 1 left above, 2 right above, 4 left below, 8 right below."""
ASCII_WALL: Final = "#"


def floor_plan(
    walls: FloatArray,
    start: tuple[float, float],
    signs: Mapping[tuple[float, float], str],
    columns: int,
    rows: int,
    *,
    ascii_only: bool,
) -> list[str]:
    """A picture of ``rows`` lines of ``columns`` characters. ``walls``: (n, 4) ``x1 y1 x2 y2`` [m]. ``start``: a place on the floor
    [m]. ``signs``: a character for each place [m], which stands where there is floor."""
    camera = Camera.fit(Scene(walls=walls).bounds, columns, rows)
    free = ~_crossed(walls, camera)
    floor = _reached(free, [_sample(camera, *start)])
    parts = floor.reshape(2 * rows, SAMPLES, 2 * columns, SAMPLES).mean(axis=(1, 3))
    at = [tuple(each // SAMPLES for each in _sample(camera, *place)) for place in (start, *signs)]
    is_floor = next(
        (found for share in SHARES if (found := _connected(parts >= share, at)) is not None), parts > 0.0
    )
    near = _grown(_grown(is_floor, 1, 1), 0, 1)  # a quarter is twice as high as it is wide
    is_wall = near & ~is_floor
    picture = [
        [
            _character(is_wall[2 * row : 2 * row + 2, 2 * column : 2 * column + 2], ascii_only)
            for column in range(columns)
        ]
        for row in range(rows)
    ]
    room = is_floor.reshape(rows, 2, columns, 2).sum(axis=(1, 3))
    for (y, x), sign in zip(at[1:], signs.values(), strict=True):
        row, column = _nearest_floor(room, y // 2, x // 2)
        picture[row][column] = sign
        room[row, column] = 0  # no other sign here
    return ["".join(line) for line in picture]


def _samples(camera: Camera, places: FloatArray) -> tuple[IntArray, IntArray]:
    """Rows and columns of the samples at places [m], (n, 2); the nearest ones of those outside."""
    bounds, scale = camera.bounds, 2 * SAMPLES
    rows = (bounds.top - places[:, 1]) / camera.cell_height * scale
    columns = (places[:, 0] - bounds.left) / camera.cell_width * scale
    last = camera.rows * scale - 1, camera.columns * scale - 1
    return rows.astype(np.int64).clip(0, last[0]), columns.astype(np.int64).clip(0, last[1])


def _sample(camera: Camera, x: float, y: float) -> tuple[int, int]:
    """Row and column of the sample at a place [m]."""
    (row,), (column,) = _samples(camera, np.array([[x, y]]))
    return int(row), int(column)


def _crossed(walls: FloatArray, camera: Camera) -> BoolArray:
    """The samples that walls cross."""
    crossed = np.zeros((camera.rows * 2 * SAMPLES, camera.columns * 2 * SAMPLES), np.bool_)
    step = camera.cell_width / (4 * SAMPLES)
    starts, ways = walls[:, :2], walls[:, 2:] - walls[:, :2]
    counts = (np.abs(ways).max(axis=1, initial=0.0) / step).astype(np.int64) + 2
    wall = np.repeat(np.arange(len(walls)), counts)
    number = np.arange(len(wall)) - np.repeat(np.cumsum(counts) - counts, counts)
    shares = number / (counts[wall] - 1)
    crossed[_samples(camera, starts[wall] + shares[:, None] * ways[wall])] = True
    return crossed


def _grown(cells: BoolArray, down: int, across: int) -> BoolArray:
    """The cells and those at most so many rows and columns away."""
    grown = cells.copy()
    for dy, dx in product(range(-down, down + 1), range(-across, across + 1)):
        to = np.s_[max(dy, 0) : cells.shape[0] + min(dy, 0), max(dx, 0) : cells.shape[1] + min(dx, 0)]
        here = np.s_[max(-dy, 0) : cells.shape[0] + min(-dy, 0), max(-dx, 0) : cells.shape[1] + min(-dx, 0)]
        grown[to] |= cells[here]
    return grown


def _reached(free: BoolArray, starts: Sequence[tuple[int, int]]) -> BoolArray:
    """The free cells that are connected with one of the starts, over their sides."""
    reached = np.zeros_like(free)
    for start in starts:
        reached[start] = True
    while True:
        grown = (_grown(reached, 1, 0) | _grown(reached, 0, 1)) & free
        if (grown == reached).all():
            return reached
        reached = grown


def _connected(cells: BoolArray, places: Sequence[tuple[int, ...]]) -> BoolArray | None:
    """The cells that are connected with all places, a cell beside each of which is enough; None where there are none."""
    around = [_grown(_only(cells.shape, place), 1, 1) & cells for place in places]
    if not around[0].any():
        return None
    reached = _reached(cells, [tuple(each) for each in np.argwhere(around[0])[:1]])
    return reached if all((each & reached).any() for each in around) else None


def _only(shape: tuple[int, ...], place: tuple[int, ...]) -> BoolArray:
    cells = np.zeros(shape, np.bool_)
    cells[place] = True
    return cells


def _character(walls: BoolArray, ascii_only: bool) -> str:
    """The character of four quarters."""
    if ascii_only:
        return ASCII_WALL if walls.sum() >= 2 else " "
    return QUARTERS[int(walls.ravel() @ np.array([1, 2, 4, 8]))]


def _nearest_floor(room: IntArray, row: int, column: int) -> tuple[int, int]:
    """The character itself where half of it is floor, else the nearest one with the most floor."""
    near = [
        (-int(room[y, x]), abs(y - row) + abs(x - column), y, x)
        for y in range(max(0, row - 1), min(row + 2, room.shape[0]))
        for x in range(max(0, column - 2), min(column + 3, room.shape[1]))
    ]
    return (row, column) if room[row, column] >= 2 else min(near)[2:]
