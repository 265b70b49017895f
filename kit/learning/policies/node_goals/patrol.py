"""How a node counts the goal to reach targets one after the other: as ``kit.learning.tasks.goals.patrol`` does."""

from __future__ import annotations

import math

import numpy as np

from kit.learning.policies.node_goals.goal_count import GoalStep, NodeCount


class PatrolCount(NodeCount):
    """The number of targets that have been reached, and the share of the time that robots have stood in the next one."""

    def count(self, count: float, step: GoalStep) -> float:
        stay = self.facts["stay"]
        if not stay:
            return count + step.arrived
        ways = np.hypot(*(step.poses - step.before)[:, :2].T)
        stood = count % 1.0 + self.facts["step_time"] / stay
        stood = 1.0 if stood > 1.0 - 1e-6 else stood
        return math.floor(count) + (stood if step.arrived and (ways < 1e-4).all() else 0.0)

    def is_done(self, before: float, count: float, step: GoalStep) -> bool:
        return math.floor(count) > math.floor(before)
