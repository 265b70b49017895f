"""What is the same for every goal that a node counts. Written into the program of each exported policy; needs numpy alone."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np


class GoalStep(NamedTuple):
    """A step of the robots, as their program knows it."""

    poses: np.ndarray
    """(robots, 3): after the step."""
    before: np.ndarray
    """(robots, 3): before it."""
    arrived: bool
    """Whether all robots are in the target."""
    place: Any
    """(2,): where the target is [m]."""
    beside: np.ndarray
    """(robots, 2): the nearest things to the left and to the right of each robot's lidar [m]."""

    @property
    def forward(self) -> np.ndarray:
        """(robots,): metres that each drove forward, none for those that drove backward."""
        dx, dy, turn = (self.poses - self.before).T
        middle = self.before[:, 2] + 0.5 * ((turn + np.pi) % (2 * np.pi) - np.pi)
        metres: np.ndarray = np.maximum(dx * np.cos(middle) + dy * np.sin(middle), 0.0)
        return metres


class NodeCount:
    """How much of the goal is achieved: nothing, where the policy is not told."""

    def __init__(self, facts: dict[str, Any]) -> None:
        self.facts = facts
        self.needed: float = facts.get("needed", 1.0)
        self.is_told_later: bool = facts.get("is_told_later", False)

    def begin(self, poses: np.ndarray) -> float:
        """The count at the start of an episode, with robots at ``poses`` (robots, 3)."""
        return 0.0

    def count(self, count: float, step: GoalStep) -> float:
        """The count after a step."""
        return count

    def is_within(self, distance: np.ndarray) -> bool:
        """Whether all distances [m] lie between the goal's nearest and farthest."""
        return bool(((distance >= self.facts["nearest"]) & (distance <= self.facts["farthest"])).all())
