"""How a node counts the goal to drive along a wall: as ``kit.learning.tasks.goals.wall`` does."""

from __future__ import annotations

import numpy as np

from kit.learning.policies.node_goals.goal_count import GoalStep, NodeCount


class WallCount(NodeCount):
    """Metres driven beside a wall, the mean of all robots."""

    def count(self, count: float, step: GoalStep) -> float:
        side = ("left", "right").index(self.facts["side"])
        is_beside = np.abs(step.beside[:, side] - self.facts["distance"]) <= self.facts["tolerance"]
        return count + float((is_beside * step.forward).mean())
