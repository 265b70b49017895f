"""Distances from segments, compared with those of many points on them."""

from __future__ import annotations

import numpy as np

from kit.segments import nearest_on_segments


def test_the_nearest_of_many_points_on_each_segment() -> None:
    chance = np.random.default_rng(3)
    points, segments = chance.uniform(-5, 5, (40, 2)), chance.uniform(-5, 5, (30, 4))
    shares = np.linspace(0.0, 1.0, 20_001)[:, None]
    distances, nearest = nearest_on_segments(points, segments)
    assert (distances.shape, nearest.shape) == ((40, 30), (40, 30, 2))
    for number, (ax, ay, bx, by) in enumerate(segments.tolist()):
        on_it = np.array([ax, ay]) + shares * np.array([bx - ax, by - ay])
        for at, point in enumerate(points):
            away = np.hypot(*(on_it - point).T)
            assert abs(distances[at, number] - away.min()) < 1e-3
            assert np.hypot(*(nearest[at, number] - point)) == distances[at, number]
            assert np.hypot(*(on_it - nearest[at, number]).T).min() < 1e-3


def test_a_segment_may_be_a_point() -> None:
    distances, nearest = nearest_on_segments(np.array([[3.0, 4.0]]), np.zeros((1, 4)))
    assert distances.tolist() == [[5.0]]
    assert nearest.tolist() == [[[0.0, 0.0]]]
