"""How a node counts the goal to drive in formation: as ``kit.learning.tasks.goals.formation`` does.

Written into the program of a policy that is told how much of its goal is achieved; needs numpy alone.
"""

from __future__ import annotations

from typing import Any

import numpy as np


class GoalCount:
    """Metres driven forward in formation, the mean of all robots."""

    def __init__(self, facts: dict[str, Any]) -> None:
        self.needed: float = facts["needed"]
        self.is_told_later: bool = facts["is_told_later"]
        self.nearest, self.farthest = facts["nearest"], facts["farthest"]

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
        distance = np.hypot(*np.diff(poses[:, :2], axis=0).T)
        is_kept = bool(((distance >= self.nearest) & (distance <= self.farthest)).all())
        dx, dy, turn = (poses - before).T
        middle = before[:, 2] + 0.5 * ((turn + np.pi) % (2 * np.pi) - np.pi)
        forward = np.maximum(dx * np.cos(middle) + dy * np.sin(middle), 0.0)
        return count + is_kept * float(forward.mean())
