"""Points, lines, circles and polygons on a grid of dots.

Coordinates are dots, x to the right and y down; dot (column, row) covers [column, column + 1) x
[row, row + 1). A grid is (height, width) uint8 and holds in each dot the role of what is seen there
(``kit.render.roles``); where several things share a dot the higher role is seen. What lies outside the
grid, or is not finite, is left out.
"""

from __future__ import annotations

import math

import numpy as np

from kit.arrays import BoolArray, FloatArray, IndexArray, Uint8Array

Grid = Uint8Array
Dots = tuple[IndexArray, IndexArray]
"""Rows and columns, in the order in which they were drawn."""


CIRCLE_CORNERS = 64
"""Corners of a circle: enough for one as large as the screen."""


def empty_grid(width: int, height: int) -> Grid:
    return np.zeros((height, width), dtype=np.uint8)


def draw_dots(grid: Grid, dots: Dots, role: int) -> None:
    """Draws dots, which all lie within the grid, unless something of a higher role is there already."""
    rows, columns = dots
    grid[rows, columns] = np.maximum(grid[rows, columns], np.uint8(role))


def point_dots(points: FloatArray, width: int, height: int) -> Dots:
    """The dots that hold the points (n, 2)."""
    x, y = points[:, 0], points[:, 1]
    inside = (x >= 0) & (x < width) & (y >= 0) & (y < height)
    return y[inside].astype(np.intp), x[inside].astype(np.intp)


def line_dots(segments: FloatArray, width: int, height: int) -> Dots:
    """The dots of straight lines (n, 4) ``x1 y1 x2 y2``, one dot thick and without gaps.

    Ends are put on dots first and the line stepped along its longer axis (Bresenham's line, all lines and
    steps at once), so that an upright or level wall is drawn as evenly as it is.
    """
    if not len(segments):
        nothing = np.empty(0, dtype=np.intp)
        return nothing, nothing
    ends = _clip_segments(segments, width, height)
    first = np.floor(ends[:, :2]).astype(np.intp)
    last = np.floor(ends[:, 2:]).astype(np.intp)
    limit = (width - 1, height - 1)  # a line that ends on the far rim belongs to the last dot
    first, last = np.minimum(first, limit), np.minimum(last, limit)
    delta = last - first
    steps = np.abs(delta).max(axis=1, initial=0)
    lengths = steps + 1
    which = np.repeat(np.arange(len(lengths)), lengths)
    step = np.arange(len(which)) - np.repeat(np.cumsum(lengths) - lengths, lengths)
    share = step / np.maximum(steps, 1)[which]
    dots = first[which] + np.floor(delta[which] * share[:, None] + 0.5).astype(np.intp)
    return dots[:, 1], dots[:, 0]


def polyline(points: FloatArray, closed: bool = False) -> FloatArray:
    """The segments (k - 1, 4), or (k, 4) if closed, that join the points (k, 2)."""
    if closed:
        points = np.concatenate((points, points[:1]))
    return np.concatenate((points[:-1], points[1:]), axis=1)


def circle_corners(x: float, y: float, radius_x: float, radius_y: float) -> FloatArray:
    """The corners (k, 2) of a polygon that looks round; its radii differ where dots are oblong."""
    angle = (np.arange(CIRCLE_CORNERS) + 0.5) * (math.tau / CIRCLE_CORNERS)
    return np.stack((x + radius_x * np.cos(angle), y + radius_y * np.sin(angle)), axis=1)


def filled_dots(corners: FloatArray, width: int, height: int) -> Dots:
    """The dots whose middles lie within the convex polygon (k, 2)."""
    nothing = np.empty(0, dtype=np.intp)
    if len(corners) < 3 or not np.isfinite(corners).all():
        return nothing, nothing
    left, top = np.clip(np.floor(corners.min(axis=0)), 0, (width, height)).astype(np.intp)
    right, bottom = np.clip(np.ceil(corners.max(axis=0)), 0, (width, height)).astype(np.intp)
    rows, columns = np.mgrid[top:bottom, left:right]
    x, y = columns.ravel() + 0.5, rows.ravel() + 0.5
    edge = np.roll(corners, -1, axis=0) - corners
    side = edge[:, :1] * (y - corners[:, 1:]) - edge[:, 1:] * (x - corners[:, :1])
    inside = (side >= 0).all(axis=0) | (side <= 0).all(axis=0)
    return rows.ravel()[inside], columns.ravel()[inside]


def drawn_cells(grid: Grid, across: int, down: int) -> BoolArray:
    """(rows, columns): the characters, of ``across`` x ``down`` dots, in which anything is drawn.

    >>> drawn_cells(np.array([[0, 0, 0, 1], [0, 0, 0, 0]], dtype=np.uint8), 2, 2).tolist()
    [[False, True]]
    """
    drawn = grid > 0
    cells: BoolArray = drawn[::down, ::across].copy()
    for row in range(down):
        for column in range(across):
            cells |= drawn[row::down, column::across]
    return cells


def close_gaps(grid: Grid, across: int, down: int, role: int) -> None:
    """Fills up to this many empty dots between two drawn ones of a column, and then of a row: in this order the
    corner between two walls is filled with them."""
    np.copyto(grid.T, np.uint8(role), where=_short_gaps(np.ascontiguousarray(grid.T > 0), down))
    np.copyto(grid, np.uint8(role), where=_short_gaps(grid > 0, across))


def _short_gaps(drawn: BoolArray, longest: int) -> BoolArray:
    """Per row: the dots in a run of at most ``longest`` that are not drawn, between two that are."""
    if longest < 1 or not drawn.size:
        return np.zeros_like(drawn)
    length = drawn.shape[1]
    at = np.arange(length)
    before = np.maximum.accumulate(np.where(drawn, at, -length), axis=1)
    after = np.minimum.accumulate(np.where(drawn, at, 2 * length)[:, ::-1], axis=1)[:, ::-1]
    gaps: BoolArray = ~drawn & (after - before - 1 <= min(longest, length))
    return gaps


def _clip_segments(segments: FloatArray, width: int, height: int) -> FloatArray:
    """The parts (m, 4) of the segments (n, 4) that lie on the grid (Liang and Barsky 1984)."""
    if (segments >= 0).all() and (segments <= (width, height, width, height)).all():
        return segments
    segments = segments[np.isfinite(segments).all(axis=1)]
    start = segments[:, :2]
    delta = segments[:, 2:] - start
    # Per axis and side: the line is inside where p * t <= q.
    p = np.concatenate((-delta, delta), axis=1)
    q = np.concatenate((start, np.array((width, height)) - start), axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        t = q / p
    enter = np.where(p < 0, t, 0.0).max(axis=1, initial=0.0)
    leave = np.where(p > 0, t, 1.0).min(axis=1, initial=1.0)
    seen = (enter <= leave) & ~((p == 0) & (q < 0)).any(axis=1)
    start, delta = start[seen], delta[seen]
    ends = start + delta * enter[seen, None], start + delta * leave[seen, None]
    # Rounding may leave an end a hair outside.
    clipped: FloatArray = np.clip(np.concatenate(ends, axis=1), 0.0, (width, height, width, height))
    return clipped
