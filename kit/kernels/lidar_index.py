"""Indexes for fast lidar scans: rays grouped into lines, walls in blocks, and the walls visible from each cell."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from kit.arrays import BoolArray, FloatArray
from kit.kernels.arrays import LANES, Beams, VisibilityCells, WallBlocks

UNIT_SQUARE = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])
SAME_DIRECTION = 3e-8
"""Directions that differ by no more are the same [rad]: less than what single precision tells apart."""
TOLERANCE = 1e-9
"""Tolerance of positions [m] and of fractions of a wall."""
CELL_SIZE = 0.25
"""Side of the cells of ``views`` [m]. Smaller ones see less, but there are more of them to keep at hand. Measured."""


def make_beams(directions: Sequence[float]) -> Beams:
    """Rays in these directions [rad], in the lidar's own frame."""
    angles = np.asarray(directions, dtype=np.float64)
    turns, folded = np.divmod(
        angles - angles[:1] + SAME_DIRECTION, np.pi
    )  # half turns since the first ray; the rest
    inwards = np.argsort(folded, kind="stable")
    same = np.empty(len(angles), dtype=np.int64)
    same[inwards] = np.cumsum(np.diff(folded[inwards], prepend=folded[inwards[:1]]) > SAME_DIRECTION)
    _, first = np.unique(same, return_index=True)
    order = np.argsort(first)  # lines in the order in which rays first lie on them
    line, heads = np.argsort(order)[same], first[order]
    backwards = (turns - turns[heads[line]]).astype(np.int64) % 2
    lines = np.full((2, -(-len(order) // LANES) * LANES), np.nan)
    lines[:, : len(order)] = np.cos(angles[heads]), np.sin(angles[heads])
    breaks = np.flatnonzero((np.diff(line) != 1) | (np.diff(backwards) != 0)) + 1
    bounds = np.concatenate([[0], breaks, [len(line)]])
    starts, ends = bounds[:-1][: len(line)], bounds[1:][: len(line)]
    runs = np.stack([starts, ends, backwards[starts], line[starts]], axis=1).astype(np.int64)
    cos, sin, drawn = (each.astype(np.float32) for each in (np.cos(angles), np.sin(angles), lines))
    return Beams(cos, sin, drawn, runs)


def make_visibility_cells(maps: Iterable[FloatArray | None]) -> VisibilityCells:
    """Views for maps, given by their walls ``(n, 4)`` [m]; None: no views for this one."""
    ends, of_cell = [np.zeros((0, 4))], [np.zeros(0, dtype=np.int64)]
    starts, corners, grids = [0], [], []
    for walls in maps:
        first = sum(len(cells) for cells in of_cell)
        if walls is None or not len(walls):
            corners.append((0.0, 0.0))
            grids.append((first, 0, 0))
            continue
        points = walls.reshape(-1, 2)
        low = points.min(axis=0)
        columns, rows = (np.ptp(points, axis=0) // CELL_SIZE + 1).astype(np.int64)
        y, x = np.divmod(np.arange(columns * rows), columns)
        cells = low + CELL_SIZE * (np.stack([x, y], axis=1)[:, None] + UNIT_SQUARE)
        seen, number = np.unique(_visible_walls(walls, cells), axis=0, return_inverse=True)
        of_cell.append(number.reshape(-1) + len(starts) - 1)
        for each in seen:
            ends.append(walls[each])
            starts.append(starts[-1] + int(each.sum()))
        corners.append((low[0], low[1]))
        grids.append((first, int(columns), int(rows)))
    return VisibilityCells(
        ends=np.concatenate(ends),
        starts=np.array(starts, dtype=np.int64),
        view_of_cell=np.concatenate(of_cell),
        map_corners=np.array(corners).reshape(-1, 2),
        map_grids=np.array(grids, dtype=np.int64).reshape(-1, 3),
        cell_size=CELL_SIZE,
    )


def _visible_walls(walls: FloatArray, cells: FloatArray) -> BoolArray:
    """(cells, n): which walls may be seen from somewhere in each cell.

    A wall is hidden from a cell by another one that every way from the cell to it crosses. Where both lie on different
    sides of that other one, the crossings of the ways from the cell's corners to the wall's ends tell: all the others
    lie between them, for a picture of straight things on a straight wall is straight.
    """
    points = walls.reshape(-1, 2, 2)
    seen = np.ones((len(cells), len(walls)), dtype=np.bool_)
    for a, b in points:
        along = b - a
        length2 = along @ along
        if not length2:
            continue
        away = along / np.sqrt(length2) @ np.array([[0.0, 1.0], [-1.0, 0.0]])
        for normal in (away, -away):
            here, there = (cells - a) @ normal, (points - a) @ normal
            near = np.flatnonzero((here > TOLERANCE).all(axis=1))
            far = np.flatnonzero((there <= TOLERANCE).all(axis=1) & (there < -TOLERANCE).any(axis=1))
            before, behind = here[near][:, None, :, None], -there[far][None, :, None, :]
            share = (before / (before + behind))[..., None]
            way = points[far][None, :, None] - cells[near][:, None, :, None]
            crossing = (cells[near][:, None, :, None] + share * way - a) @ along / length2
            hidden = ((crossing >= -TOLERANCE) & (crossing <= 1 + TOLERANCE)).all(axis=(2, 3))
            seen[np.ix_(near, far)] &= ~hidden
    return seen


def make_wall_blocks(ends: FloatArray, size: int = 32) -> WallBlocks:
    """Walls ``(n, 4)`` ``x1 y1 x2 y2`` [m]: halved along the longer side until no block exceeds ``size``.

    A scan then looks into a block only where some ray meets its disc. Measured on 170 to 5,000 segments: blocks of
    16 to 32 are best; a tree of discs gains a third on the largest map and loses as much on small ones.
    """
    middles = 0.5 * (ends[:, :2] + ends[:, 2:])
    blocks, waiting = [], [np.arange(len(ends))]
    while waiting:
        block = waiting.pop()
        if len(block) <= size:
            blocks.append(block)
            continue
        longer = int(np.argmax(np.ptp(middles[block], axis=0)))
        block = block[np.argsort(middles[block, longer], kind="stable")]
        waiting += [block[len(block) // 2 :], block[: len(block) // 2]]
    starts = np.cumsum([0, *map(len, blocks)], dtype=np.int64)
    ordered = np.ascontiguousarray(ends[np.concatenate(blocks)], dtype=np.float64)
    discs = [_bounding_disc(ends[block]) for block in blocks if len(block)]
    return WallBlocks(ordered, starts, np.array(discs, dtype=np.float64).reshape(-1, 3))


def _bounding_disc(ends: FloatArray) -> tuple[float, float, float]:
    """``x y radius`` [m]."""
    points = ends.reshape(-1, 2)
    x, y = 0.5 * (points.min(axis=0) + points.max(axis=0))
    return x, y, np.hypot(points[:, 0] - x, points[:, 1] - y).max()
