"""How a node counts the goal to be in a target: as ``kit.learning.tasks.goals.target`` does."""

from __future__ import annotations

from kit.learning.policies.node_goals.goal_count import GoalStep, NodeCount


class TargetCount(NodeCount):
    """1 while every robot is in the target, else 0."""

    def count(self, count: float, step: GoalStep) -> float:
        return float(step.arrived)
