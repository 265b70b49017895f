"""SARSA in a grid world: as Q-learning, but what follows is worth what the move is that is really made there.

Sutton and Barto, Reinforcement Learning, 2nd edition, section 6.4.
"""

from __future__ import annotations

from typing import ClassVar

from kit.learning.grid.grid_learner import GridLearner
from kit.learning.grid.grid_world import GridCell
from kit.learning.grid.q_learning import choose_by_values


class SarsaLearner(GridLearner):
    """Learns what each move in each cell is worth, as the learner itself goes on, its random moves included."""

    algorithm: ClassVar[str] = "sarsa"

    def choose(self, cell: GridCell) -> int:
        return choose_by_values(self.values[cell], self.settings, self.rng)

    def learn(
        self, cell: GridCell, move: int, reward: float, reached: GridCell, next_move: int, terminated: bool
    ) -> float:
        settings = self.settings
        future = 0.0 if terminated else settings.gamma * float(self.values[reached][next_move])
        target = reward + future
        self.values[cell][move] += settings.alpha * (target - float(self.values[cell][move]))
        return target
