"""A trail: points that stay where they are and grow fewer with age."""

from __future__ import annotations

import numpy as np

from kit.render.trail import Trail


def test_points_keep_their_distance() -> None:
    trail = Trail(spacing=0.1)
    for step in range(101):
        trail.add(0.01 * step, 0.0)
    gaps = np.diff(trail.points[:, 0])
    assert (gaps >= 0.1 - 1e-9).all()
    assert (gaps < 0.12).all()


def test_the_old_part_is_thinner_and_the_oldest_is_gone() -> None:
    trail = Trail(spacing=1.0, length=80)
    for step in range(200):
        trail.add(float(step), 0.0)
    age = 199 - trail.points[:, 0]
    assert age.max() < 80
    counts = [int(((age >= low) & (age < low + 20)).sum()) for low in (60, 40, 20, 0)]
    assert counts == [5, 10, 20, 20]


def test_a_point_never_comes_back_or_moves() -> None:
    trail = Trail(spacing=1.0, length=40)
    seen: set[float] = set()
    gone: set[float] = set()
    for step in range(300):
        trail.add(float(step), 0.0)
        now = set(trail.points[:, 0].tolist())
        assert not now & gone
        gone |= seen - now
        seen = now


def test_an_empty_trail_is_an_array_all_the_same() -> None:
    trail = Trail()
    assert trail.points.shape == (0, 2)
    trail.add(1.0, 2.0)
    assert trail.points.tolist() == [[1.0, 2.0]]
    trail.clear()
    assert trail.points.shape == (0, 2)
