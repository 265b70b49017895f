"""Distances between points and line segments in the plane, all at once."""

from __future__ import annotations

import numpy as np

from kit.arrays import FloatArray


def nearest_on_segments(points: FloatArray, segments: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Returns the distances (p, s) [m] of points (p, 2) from segments (s, 4) ``x1 y1 x2 y2``, and the segments' nearest points
    (p, s, 2). A segment may be a point.

    >>> distance, nearest = nearest_on_segments(np.array([[1.0, 2.0]]), np.array([[0.0, 0.0, 3.0, 0.0], [5.0, 5.0, 5.0, 5.0]]))
    >>> distance.tolist(), nearest.tolist()
    ([[2.0, 5.0]], [[[1.0, 0.0], [5.0, 5.0]]])
    """
    start, along = segments[:, :2], segments[:, 2:] - segments[:, :2]
    length2 = np.maximum((along**2).sum(axis=1), 1e-18)
    share = np.clip(((points[:, None] - start) * along).sum(axis=2) / length2, 0.0, 1.0)
    nearest = start + share[..., None] * along
    away = nearest - points[:, None]
    return np.hypot(away[..., 0], away[..., 1]), nearest
