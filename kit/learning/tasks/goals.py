"""What an episode is to achieve, as records: a target, a patrol, a floor to cover, a wall, a leader, carts to avoid.

Every goal is a count that grows until it is full: then the episode has reached its goal.

Places where episodes start or end: poses, areas, or anywhere on free floor.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final, Literal, TypeAlias

from kit.geometry import Pose


@dataclass(frozen=True, slots=True)
class TargetGoal:
    """Every robot is in the target at the same time."""

    heading_tolerance: float | None = None
    """The target's heading must be kept within this [rad]; None: any heading will do."""

    @property
    def description(self) -> str:
        if self.heading_tolerance is None:
            return "be in the target"
        return f"be in the target, within {self.heading_tolerance:g} rad of its heading"


@dataclass(frozen=True, slots=True)
class PatrolGoal:
    """The case's targets are reached one after the other."""

    rounds: int = 1
    """So many times all of them."""

    @property
    def description(self) -> str:
        return f"reach all targets in their order, {self.rounds} time{'s' if self.rounds > 1 else ''}"

    def route(self, targets: tuple[tuple[float, float], ...]) -> tuple[tuple[float, float], ...]:
        """The targets of all rounds, one after the other [m, m]; ``targets``: those of one."""
        return targets * self.rounds


@dataclass(frozen=True, slots=True)
class CoverGoal:
    """A share of the floor that can be reached is driven over."""

    share: float = 0.9
    radius: float = 0.15
    """A robot covers what lies within this of its origin [m]."""

    @property
    def description(self) -> str:
        return f"cover {self.share:.0%} of the floor, all within {self.radius:g} m of the robot"


@dataclass(frozen=True, slots=True)
class WallGoal:
    """Every robot drives along a wall on one side of it."""

    side: Literal["left", "right"] = "right"
    distance: float = 0.25
    """From the lidar to the wall [m]."""
    tolerance: float = 0.1
    """Metres driven count where the distance is off by at most this [m]."""
    length: float = 5.0
    """So many metres in all."""

    @property
    def description(self) -> str:
        return (
            f"drive {self.length:g} m with a wall on the {self.side}, "
            f"{self.distance - self.tolerance:g} to {self.distance + self.tolerance:g} m away"
        )


@dataclass(frozen=True, slots=True)
class FollowGoal:
    """Every robot stays near a target that moves."""

    nearest: float = 0.3
    farthest: float = 0.8
    """Between these distances [m] from the target's middle time counts."""
    time: float = 20.0
    """So many seconds in all."""

    @property
    def description(self) -> str:
        return f"be {self.nearest:g} to {self.farthest:g} m from the leader for {self.time:g} s in all"


@dataclass(frozen=True, slots=True)
class AvoidGoal:
    """No robot comes near a moving model."""

    distance: float = 0.4
    """Seconds count in which every moving model is farther than this from every robot's origin [m]."""
    time: float = 20.0
    """So many seconds in all."""

    @property
    def description(self) -> str:
        return f"be more than {self.distance:g} m from everything that moves, for {self.time:g} s in all"


REACH_TARGET: Final = TargetGoal()
"""What most tasks ask for."""

Goal: TypeAlias = TargetGoal | PatrolGoal | CoverGoal | WallGoal | FollowGoal | AvoidGoal


Area = tuple[float, float, float, float]
"""``x1 y1 x2 y2`` [m]: an upright rectangle, by two opposite corners."""


@dataclass(frozen=True, slots=True)
class EpisodePlaces:
    """Places of which every episode takes one, each as likely as the others; poses where there are any, else an area.

    Of an area only the floor counts on which a robot of any heading touches nothing, and from which the rest of the
    task can be reached.
    """

    poses: tuple[Pose, ...] = ()
    """For targets the heading counts only where the goal asks for one."""
    area: Area | None = None
    """Its floor; None with no poses: the floor of the whole map."""
    headings: tuple[float, float] = (-math.pi, math.pi)
    """Headings in an area are drawn between these [rad]."""
    model: str | None = None
    """Targets only: the target moves with this model of the world."""

    @property
    def is_area(self) -> bool:
        """Whether places are drawn from the floor."""
        return not self.poses and self.model is None

    @property
    def nominal(self) -> Pose:
        """One pose that stands for all: the first, or the middle of the area; the origin for a whole map."""
        if self.poses:
            return self.poses[0]
        if self.area is None:
            return Pose()
        x1, y1, x2, y2 = self.area
        return Pose((x1 + x2) / 2, (y1 + y2) / 2, sum(self.headings) / 2)

    @property
    def description(self) -> str:
        """``(0, 0)``, ``one of 4 places``, ``anywhere``."""
        if self.model is not None:
            return f"the moving {self.model}"
        if len(self.poses) == 1:
            return f"({self.poses[0].x:g}, {self.poses[0].y:g})"
        if self.poses:
            return f"one of {len(self.poses)} places"
        if self.area is None:
            return "anywhere on free floor"
        x1, y1, x2, y2 = self.area
        return f"anywhere free from ({x1:g}, {y1:g}) to ({x2:g}, {y2:g})"
