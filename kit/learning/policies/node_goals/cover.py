"""How a node counts the goal to drive over a share of the floor: as ``kit.learning.tasks.goals.cover`` does."""

from __future__ import annotations

import base64
import zlib
from typing import Any

import numpy as np

from kit.learning.policies.node_goals.goal_count import GoalStep, NodeCount


class CoverCount(NodeCount):
    """The number of cells of the floor that have been covered."""

    def __init__(self, facts: dict[str, Any]) -> None:
        super().__init__(facts)
        self.radius, cell, (x, y) = facts["radius"], facts["cell"], facts["origin"]
        packed = np.frombuffer(zlib.decompress(base64.b64decode(facts["floor"])), dtype=np.uint8)
        rows, columns = facts["shape"]
        floor = np.unpackbits(packed)[: rows * columns].reshape(rows, columns).nonzero()
        self.cells = np.stack((x + cell * floor[1], y + cell * floor[0]))
        """(2, k) the middles of all cells that count [m]."""
        self.covered = np.zeros(self.cells.shape[1], dtype=bool)

    def begin(self, poses: np.ndarray) -> float:
        self.covered[:] = False
        return self.cover(poses)

    def count(self, count: float, step: GoalStep) -> float:
        return self.cover(step.poses)

    def cover(self, poses: np.ndarray) -> float:
        """Marks what robots at these poses cover, and returns how many cells have been covered."""
        for x, y, _ in poses:
            dx, dy = self.cells[0] - x, self.cells[1] - y
            self.covered |= dx * dx + dy * dy <= self.radius * self.radius
        return float(self.covered.sum())
