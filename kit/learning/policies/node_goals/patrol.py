"""How a node counts the goal to reach targets one after the other: as ``kit.learning.tasks.goals.patrol`` does."""

from __future__ import annotations

from kit.learning.policies.node_goals.goal_count import GoalStep, NodeCount


class PatrolCount(NodeCount):
    """The number of targets that have been reached."""

    def count(self, count: float, step: GoalStep) -> float:
        return count + step.arrived
