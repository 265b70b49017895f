"""Walls in the order in which a lidar looks at them."""

from __future__ import annotations

import numpy as np

from kit.arrays import Floats, Segments


def in_blocks(ends: Floats, size: int = 32) -> Segments:
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
    discs = [_disc_around(ends[block]) for block in blocks if len(block)]
    return Segments(ordered, starts, np.array(discs, dtype=np.float64).reshape(-1, 3))


def _disc_around(ends: Floats) -> tuple[float, float, float]:
    """``x y radius`` [m]."""
    points = ends.reshape(-1, 2)
    x, y = 0.5 * (points.min(axis=0) + points.max(axis=0))
    return x, y, np.hypot(points[:, 0] - x, points[:, 1] - y).max()
