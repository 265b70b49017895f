"""The convex hull of a few points."""

from __future__ import annotations

from collections.abc import Iterable

Point = tuple[float, float]


def convex_hull(points: Iterable[Point]) -> tuple[Point, ...]:
    """The corners of the smallest convex polygon around the points, counter-clockwise, none in line with its
    neighbours. Fewer than three if the points lie on one line.

    Andrew's monotone chain (Information Processing Letters 9, 1979): O(n log n).
    """
    ordered = sorted(set(points))
    lower, upper = _chain(ordered), _chain(ordered[::-1])
    return tuple(lower[:-1] + upper[:-1]) if len(ordered) > 1 else tuple(ordered)


def area(corners: tuple[Point, ...]) -> float:
    """The area inside a polygon whose corners are given counter-clockwise; 0 for fewer than three."""
    return 0.5 * sum(
        x1 * y2 - x2 * y1 for (x1, y1), (x2, y2) in zip(corners, corners[1:] + corners[:1], strict=True)
    )


def _chain(points: list[Point]) -> list[Point]:
    """The part of the hull that turns left all the way from the first point to the last."""
    chain: list[Point] = []
    for point in points:
        while len(chain) > 1 and _turn(chain[-2], chain[-1], point) <= 0:
            chain.pop()
        chain.append(point)
    return chain


def _turn(a: Point, b: Point, c: Point) -> float:
    """Twice the area of the triangle a, b, c: positive if it turns left."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
