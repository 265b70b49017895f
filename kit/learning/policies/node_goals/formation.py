"""How a node counts the goal to drive in formation: as ``kit.learning.tasks.goals.formation`` does."""

from __future__ import annotations

import numpy as np

from kit.learning.policies.node_goals.goal_count import GoalStep, NodeCount


class FormationCount(NodeCount):
    """Metres driven forward in formation, the mean of all robots."""

    def count(self, count: float, step: GoalStep) -> float:
        distance = np.hypot(*np.diff(step.poses[:, :2], axis=0).T)
        return count + self.is_within(distance) * float(step.forward.mean())
