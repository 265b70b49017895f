"""How a node counts the goal to stay near a target that moves: as ``kit.learning.tasks.goals.follow`` does.

Written into the program of a policy that is told how much of its goal is achieved; needs numpy alone.
"""

from __future__ import annotations

from typing import Any

import numpy as np


class GoalCount:
    """Seconds in which every robot was near its leader."""

    def __init__(self, facts: dict[str, Any]) -> None:
        self.needed: float = facts["needed"]
        self.is_told_later: bool = facts["is_told_later"]
        self.nearest, self.farthest, self.step_time = facts["nearest"], facts["farthest"], facts["step_time"]

    def begin(self, poses: np.ndarray) -> float:
        return 0.0

    def count(
        self,
        count: float,
        poses: np.ndarray,
        before: np.ndarray,
        arrived: bool,
        place: Any,
        beside: np.ndarray,
    ) -> float:
        distance = np.hypot(*(poses[:, :2] - place).T)
        is_near = bool(((distance >= self.nearest) & (distance <= self.farthest)).all())
        return count + is_near * float(self.step_time)
