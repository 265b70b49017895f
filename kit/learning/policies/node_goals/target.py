"""How a node counts the goal to be in a target: as ``kit.learning.tasks.goals.target`` does.

Written into the program of a policy that is told how much of its goal is achieved; needs numpy alone.
"""

from __future__ import annotations

from typing import Any

import numpy as np


class GoalCount:
    """1 while every robot is in the target, else 0."""

    def __init__(self, facts: dict[str, Any]) -> None:
        self.needed: float = facts["needed"]
        self.is_told_later: bool = facts["is_told_later"]

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
        return float(arrived)
