"""Poses and angles in the plane: metres, radians, x forward, y left, counter-clockwise positive."""

from __future__ import annotations

import math
from typing import NamedTuple


def wrap_angle(angle: float) -> float:
    """The same direction as ``angle`` [rad], in [-pi, pi)."""
    return (angle + math.pi) % math.tau - math.pi


class Pose(NamedTuple):
    """A place and a heading: ``x``, ``y`` [m] and ``theta`` [rad]. Also a frame, whose origin it is."""

    x: float = 0.0
    y: float = 0.0
    theta: float = 0.0

    def point(self, x: float, y: float) -> tuple[float, float]:
        """Where the point ``(x, y)`` [m] of this frame lies in the frame in which the pose is given."""
        cos, sin = math.cos(self.theta), math.sin(self.theta)
        return self.x + cos * x - sin * y, self.y + sin * x + cos * y

    def compose(self, inner: Pose) -> Pose:
        """The pose ``inner``, given in this frame, in the frame in which this pose is given."""
        x, y = self.point(inner.x, inner.y)
        return Pose(x, y, self.theta + inner.theta)

    def relative(self, other: Pose) -> Pose:
        """The pose ``other`` as seen from this frame: ``self.compose(self.relative(other)) == other``."""
        cos, sin = math.cos(self.theta), math.sin(self.theta)
        dx, dy = other.x - self.x, other.y - self.y
        return Pose(cos * dx + sin * dy, cos * dy - sin * dx, other.theta - self.theta)
