"""Compiled loops over grids, charges and bodies that call no other kernel."""

from __future__ import annotations

import math

import numpy as np

from kit.arrays import BoolArray, Float32Array, FloatArray, IntArray
from kit.kernels.arrays import ObstacleParts
from kit.kernels.compilation import jit, jit_without_gil


@jit
def find_nearest_obstacles(
    parts: ObstacleParts,
    maps: IntArray,
    bodies: FloatArray,
    poses: FloatArray,
    nearest: FloatArray,
) -> None:
    """Fills ``nearest`` (n, r): from each robot's origin to the middle of the nearest obstacle's body [m], at most what is in it."""
    for i in range(poses.shape[0]):
        for p in range(parts.map_parts[maps[i]], parts.map_parts[maps[i] + 1]):
            body = bodies[i, parts.body[p]]
            for k in range(poses.shape[1]):
                away = math.hypot(body[0] - poses[i, k, 0], body[1] - poses[i, k, 1])
                nearest[i, k] = min(nearest[i, k], away)


@jit
def cover_cells(
    poses: FloatArray,
    cases: IntArray,
    origins: FloatArray,
    cell: float,
    floors: BoolArray,
    radius: float,
    covered: BoolArray,
    counts: FloatArray,
) -> None:
    """Marks in ``covered`` (n, rows, columns) the cells whose middles lie within ``radius`` of a robot, and adds to ``counts``
    (n,) those that count and were not marked.

    ``floors`` (cases, rows, columns): which cells count; ``origins`` (cases, 2): the middle of the first one.
    """
    reach = int(radius / cell) + 1
    for i in range(poses.shape[0]):
        case = cases[i]
        for k in range(poses.shape[1]):
            column = round((poses[i, k, 0] - origins[case, 0]) / cell)
            row = round((poses[i, k, 1] - origins[case, 1]) / cell)
            for r in range(max(row - reach, 0), min(row + reach + 1, floors.shape[1])):
                for c in range(max(column - reach, 0), min(column + reach + 1, floors.shape[2])):
                    dx = origins[case, 0] + c * cell - poses[i, k, 0]
                    dy = origins[case, 1] + r * cell - poses[i, k, 1]
                    near = dx * dx + dy * dy <= radius * radius
                    if near and floors[case, r, c] and not covered[i, r, c]:
                        covered[i, r, c] = True
                        counts[i] += 1.0


@jit
def relax_path_lengths(lengths: FloatArray, price: FloatArray, cell: float) -> None:
    """Lowers ``lengths`` (rows, columns) [m], infinite where unknown, to those of the cheapest ways from where they are known.

    A step between two of a cell's eight neighbours counts for its length times the mean ``price`` of its ends. Swept
    to and fro until nothing changes (Zhao 2005); the fixed point does not depend on the order.
    """
    rows, columns = lengths.shape
    changed = True
    while changed:
        changed = False
        for sweep in range(4):
            for i in range(rows):
                row = i if sweep < 2 else rows - 1 - i
                for j in range(columns):
                    column = j if sweep % 2 == 0 else columns - 1 - j
                    least = lengths[row, column]
                    for dx in range(-1, 2):
                        for dy in range(-1, 2):
                            r, c = row + dy, column + dx
                            if (dx or dy) and 0 <= r < rows and 0 <= c < columns:
                                toll = 0.5 * cell * math.sqrt(dx * dx + dy * dy)
                                way = lengths[r, c] + toll * (price[row, column] + price[r, c])
                                least = min(least, way)
                    if least < lengths[row, column]:
                        lengths[row, column] = least
                        changed = True


@jit_without_gil
def add_rotations(before: FloatArray, turn: FloatArray, rotation: FloatArray) -> None:
    """Fills ``rotation`` (n, r) [rad] since each robot last turned to the other side; that was ``before`` (n, r) a step that
    turned them by ``turn`` (n, r)."""
    for i in range(before.shape[0]):
        for k in range(before.shape[1]):
            rotation[i, k] = turn[i, k] if before[i, k] * turn[i, k] < 0.0 else before[i, k] + turn[i, k]


@jit_without_gil
def interpolate_tables(
    tables: Float32Array,
    corners: FloatArray,
    cell: float,
    cases: IntArray,
    poses: FloatArray,
    found: FloatArray,
) -> None:
    """Fills ``found`` (n, r) from a table each case has, between the four nearest cells.

    ``tables`` (cases, rows, columns): values at the middles of square cells; ``corners`` (cases, 2): the first middle.
    """
    for i in range(poses.shape[0]):
        table = tables[cases[i]]
        for k in range(poses.shape[1]):
            u = min(max((poses[i, k, 0] - corners[cases[i], 0]) / cell, 0.0), table.shape[1] - 1.001)
            v = min(max((poses[i, k, 1] - corners[cases[i], 1]) / cell, 0.0), table.shape[0] - 1.001)
            column, row = int(u), int(v)
            u, v = u - column, v - row
            below = (1.0 - u) * table[row, column] + u * table[row, column + 1]
            above = (1.0 - u) * table[row + 1, column] + u * table[row + 1, column + 1]
            found[i, k] = (1.0 - v) * below + v * above


@jit
def add_forces(
    x: FloatArray,
    y: FloatArray,
    charges: FloatArray,
    starts: IntArray,
    fx: FloatArray,
    fy: FloatArray,
) -> None:
    """Adds to ``fx``, ``fy`` (n) the forces of charges at the points ``x``, ``y`` (n); see ``kit.fields.charges``.

    ``charges`` (m, 9) ``ax ay ux uy length low high intensity rank``: stretches from a along the unit vector u, that
    act where the foot of the perpendicular lies from ``low`` to ``high`` along them. Of those from ``starts[c]``
    on, before the next start, the one of the least rank + r^2 acts, with intensity / r^2; none at r = 0.
    """
    n = x.shape[0]
    least, away_x, away_y, pull = np.empty(n), np.empty(n), np.empty(n), np.empty(n)
    for c in range(starts.shape[0] - 1):
        least[:], away_x[:], away_y[:], pull[:] = math.inf, 0.0, 0.0, 0.0
        for ax, ay, ux, uy, length, low, high, intensity, rank in charges[starts[c] : starts[c + 1]]:
            for i in range(n):
                dx, dy = ax - x[i], ay - y[i]
                along = -(dx * ux + dy * uy)
                share = min(max(along, 0.0), length)
                dx, dy = dx + share * ux, dy + share * uy
                key = rank + dx * dx + dy * dy
                acts = (along >= low) & (along <= high) & (key < least[i])
                least[i] = key if acts else least[i]
                away_x[i] = dx if acts else away_x[i]
                away_y[i] = dy if acts else away_y[i]
                pull[i] = intensity if acts else pull[i]
        for i in range(n):
            square = away_x[i] * away_x[i] + away_y[i] * away_y[i]
            cube = square * math.sqrt(square)
            share = pull[i] / cube if cube > 0.0 else 0.0
            fx[i] += share * away_x[i]
            fy[i] += share * away_y[i]
