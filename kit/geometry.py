"""Poses, angles and convex polygons in the plane: metres, radians, x forward, y left, counter-clockwise positive."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING, NamedTuple, TypeVar

if TYPE_CHECKING:
    from kit.arrays import FloatArray

Point = tuple[float, float]
AngleT = TypeVar("AngleT", float, "FloatArray")


def wrap_angle(angle: AngleT) -> AngleT:
    """``angle`` [rad], a number or an array, wrapped to [-pi, pi)."""
    return (angle + math.pi) % math.tau - math.pi


def whole_degrees(angle: float) -> int:
    """``angle`` [rad] in whole degrees, wrapped to (-180, 180]: as it is shown to people.

    >>> whole_degrees(-math.pi), whole_degrees(math.radians(-179.7)), whole_degrees(math.radians(269.0))
    (180, 180, -91)
    """
    degrees = round(math.degrees(math.remainder(angle, math.tau)))
    return 180 if degrees == -180 else degrees


class Pose(NamedTuple):
    """A position and a heading: ``x``, ``y`` [m] and ``theta`` [rad]. Also a frame, whose origin it is."""

    x: float = 0.0
    y: float = 0.0
    theta: float = 0.0

    def transform_point(self, x: float, y: float) -> tuple[float, float]:
        """Returns the point ``(x, y)`` [m] of this frame in the frame in which the pose is given."""
        cos, sin = math.cos(self.theta), math.sin(self.theta)
        return self.x + cos * x - sin * y, self.y + sin * x + cos * y

    def compose(self, inner: Pose) -> Pose:
        """The pose ``inner``, given in this frame, in the frame in which this pose is given."""
        if inner == ORIGIN and 0.0 not in self:  # to add 0 changes nothing but -0.0
            return self
        x, y = self.transform_point(inner.x, inner.y)
        return Pose(x, y, self.theta + inner.theta)

    def relative(self, other: Pose) -> Pose:
        """The pose ``other`` as seen from this frame: ``self.compose(self.relative(other)) == other``."""
        cos, sin = math.cos(self.theta), math.sin(self.theta)
        dx, dy = other.x - self.x, other.y - self.y
        return Pose(cos * dx + sin * dy, cos * dy - sin * dx, other.theta - self.theta)


ORIGIN = Pose()


def convex_hull(points: Iterable[Point]) -> tuple[Point, ...]:
    """The corners of the smallest convex polygon around the points, counter-clockwise, none in line with its
    neighbours. Fewer than three if the points lie on one line.

    Andrew's monotone chain (Information Processing Letters 9, 1979): O(n log n).
    """
    ordered = sorted(set(points))
    lower, upper = _hull_chain(ordered), _hull_chain(ordered[::-1])
    return tuple(lower[:-1] + upper[:-1]) if len(ordered) > 1 else tuple(ordered)


def polygon_area(corners: tuple[Point, ...]) -> float:
    """The area inside a polygon whose corners are given counter-clockwise; 0 for fewer than three."""
    return 0.5 * sum(
        x1 * y2 - x2 * y1 for (x1, y1), (x2, y2) in zip(corners, corners[1:] + corners[:1], strict=True)
    )


def _hull_chain(points: list[Point]) -> list[Point]:
    """The part of the hull that turns left all the way from the first point to the last."""
    chain: list[Point] = []
    for point in points:
        while len(chain) > 1 and _twice_signed_area(chain[-2], chain[-1], point) <= 0:
            chain.pop()
        chain.append(point)
    return chain


def _twice_signed_area(a: Point, b: Point, c: Point) -> float:
    """Twice the area of the triangle a, b, c: positive if it turns left."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
