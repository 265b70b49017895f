"""How a node counts the goal to stay near a target that moves: as ``kit.learning.tasks.goals.follow`` does."""

from __future__ import annotations

import numpy as np

from kit.learning.policies.node_goals.goal_count import GoalStep, NodeCount


class FollowCount(NodeCount):
    """Seconds in which every robot was near its leader."""

    def count(self, count: float, step: GoalStep) -> float:
        distance = np.hypot(*(step.poses[:, :2] - step.place).T)
        return count + self.is_within(distance) * float(self.facts["step_time"])
