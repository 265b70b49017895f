"""Leaves out walls that no robot can meet or see: those behind others, as seen from the floor."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from kit.arrays import BoolArray, FloatArray, IndexArray

# Walls that can be seen

SAME_DECIMALS = 9
"""Decimals to which ends of walls must agree to be the same point."""


def cull_walls(walls: FloatArray, point: tuple[float, float]) -> FloatArray:
    """Returns the walls (n, 4) ``x1 y1 x2 y2`` that are not wholly outside the smallest ring around ``point``; in their order.

    A ring is a closed chain of walls that share ends two by two. All walls where there is none.
    """
    around = [ring for ring in find_rings(walls) if is_inside(np.array([point]), walls[ring])[0]]
    if not around:
        return walls
    ring = min(around, key=lambda each: float(np.prod(np.ptp(walls[each].reshape(-1, 2), axis=0))))
    kept = is_inside(walls[:, :2], walls[ring]) | is_inside(walls[:, 2:], walls[ring])
    kept[ring] = True
    outside = np.flatnonzero(~kept)
    kept[outside] = _is_crossing(walls[outside], walls[ring])
    return walls[kept]


def find_rings(walls: FloatArray) -> Iterator[IndexArray]:
    """The numbers of the walls of each ring."""
    import networkx as nx  # here: it takes longer than all else that a world in batches imports

    graph = nx.MultiGraph()
    for number, (x1, y1, x2, y2) in enumerate(walls.round(SAME_DECIMALS).tolist()):
        graph.add_edge((x1, y1), (x2, y2), number=number)
    for part in nx.connected_components(graph):
        ring = graph.subgraph(part)
        if len(part) > 2 and all(degree == 2 for _, degree in ring.degree):
            yield np.array([number for *_, number in ring.edges(data="number")])


def is_inside(points: FloatArray, ring: FloatArray) -> BoolArray:
    """(n,) which of the points (n, 2) a ring (m, 4) encloses: a ray from there to the right meets it an odd number of
    times."""
    x, y = points[:, :1], points[:, 1:]
    x1, y1, x2, y2 = ring.T
    level = (y1 > y) != (y2 > y)
    rise = np.where(y2 == y1, 1.0, y2 - y1)
    odd: BoolArray = (level & (x < x1 + (y - y1) / rise * (x2 - x1))).sum(axis=1) % 2 == 1
    return odd


def _is_crossing(walls: FloatArray, ring: FloatArray) -> BoolArray:
    """(n,) which of the walls meet one of the ring's."""
    a, b = walls[:, None, :2], walls[:, None, 2:]
    c, d = ring[None, :, :2], ring[None, :, 2:]
    apart = (_side(a, b, c) * _side(a, b, d) > 0) | (_side(c, d, a) * _side(c, d, b) > 0)
    meets: BoolArray = np.logical_not(apart.all(axis=1))
    return meets


def _side(a: FloatArray, b: FloatArray, c: FloatArray) -> FloatArray:
    """Positive where the points c lie to the left of the line from a to b, negative to the right."""
    cross: FloatArray = (b[..., 0] - a[..., 0]) * (c[..., 1] - a[..., 1]) - (b[..., 1] - a[..., 1]) * (
        c[..., 0] - a[..., 0]
    )
    return cross
