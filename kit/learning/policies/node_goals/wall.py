"""How a node counts the goal to drive along a wall: as ``kit.learning.tasks.goals.wall`` does.

Written into the program of a policy that is told how much of its goal is achieved; needs numpy alone.
"""

from __future__ import annotations

from typing import Any

import numpy as np


class GoalCount:
    """Metres driven beside a wall, the mean of all robots."""

    def __init__(self, facts: dict[str, Any]) -> None:
        self.needed: float = facts["needed"]
        self.is_told_later: bool = facts["is_told_later"]
        self.side = ("left", "right").index(facts["side"])
        self.distance, self.tolerance = facts["distance"], facts["tolerance"]

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
        (dx, dy, turn), heading = (poses - before).T, before[:, 2]
        middle = heading + 0.5 * ((turn + np.pi) % (2 * np.pi) - np.pi)
        forward = np.maximum(dx * np.cos(middle) + dy * np.sin(middle), 0.0)
        is_beside = np.abs(beside[:, self.side] - self.distance) <= self.tolerance
        return count + float((is_beside * forward).mean())
