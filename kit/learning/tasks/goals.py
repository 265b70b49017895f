"""What an episode is to achieve, as records: a target, a patrol, a floor to cover, a wall, a leader, carts to avoid.

Every goal is a count that grows until it is full: then the episode has reached its goal.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal, TypeAlias


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
