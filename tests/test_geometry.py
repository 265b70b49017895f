"""The convex hull of a footprint's points."""

from __future__ import annotations

import math
from itertools import pairwise

from hypothesis import given
from hypothesis import strategies as st

from kit.geometry import convex_hull, polygon_area, whole_degrees

grid = st.integers(-4, 4).map(float)
points = st.lists(st.tuples(grid, grid), max_size=8)


def turn(a: tuple[float, float], b: tuple[float, float], c: tuple[float, float]) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


@given(points)
def test_the_hull_turns_left_at_every_corner_and_holds_every_point(points: list[tuple[float, float]]) -> None:
    hull = convex_hull(points)
    assert set(hull) <= set(points)
    if len(hull) < 3:
        assert polygon_area(hull) == 0
        return
    ring = [*hull, *hull[:2]]
    assert all(turn(a, b, c) > 0 for a, b, c in zip(ring, ring[1:], ring[2:], strict=False))
    assert all(turn(a, b, point) >= 0 for a, b in pairwise(ring) for point in points)
    assert polygon_area(hull) > 0


@given(points, st.randoms())
def test_the_order_of_the_points_does_not_matter(points: list[tuple[float, float]], random: object) -> None:
    shuffled = list(points)
    random.shuffle(shuffled)  # type: ignore[attr-defined]  # hypothesis calls it a Random
    assert convex_hull(shuffled) == convex_hull(points)


def test_a_square_with_points_within_and_along_its_sides() -> None:
    square = ((0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0))
    assert convex_hull([(1, 1), *reversed(square), (1, 0), (0, 1)]) == square
    assert polygon_area(square) == 4


@given(st.floats(-1e3, 1e3))
def test_degrees_are_above_minus_180_and_at_most_180(angle: float) -> None:
    degrees = whole_degrees(angle)
    assert -180 < degrees <= 180
    assert abs(math.remainder(math.radians(degrees) - angle, math.tau)) <= math.radians(0.5) + 1e-9
