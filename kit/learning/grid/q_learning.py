"""Q-learning in a grid world: a table of values, and one rule that changes one of them after each step.

The same rule as ``training/tabular.py`` applies to many worlds at once (Sutton and Barto, Reinforcement Learning, 2nd
edition, section 6.5).
"""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from kit.arrays import FloatArray
from kit.learning.grid.grid_learner import GridLearner
from kit.learning.grid.grid_world import GridCell


class QLearner(GridLearner):
    """Learns what each move in each cell is worth, as if the best moves followed.

    >>> from kit.learning.grid.grid_learner import GridLearnerSettings
    >>> from kit.learning.grid.grid_world import GridWorld
    >>> learner = QLearner(GridWorld(("SG",)), GridLearnerSettings(epsilon=0.0, alpha=0.5))
    >>> while learner.episodes < 3:
    ...     _ = learner.step()
    >>> float(learner.values[0, 0, 0])
    0.875
    """

    algorithm: ClassVar[str] = "q-learning"

    def choose(self, cell: GridCell) -> int:
        return epsilon_greedy(self.values[cell], self.settings.epsilon, self.rng)

    def learn(
        self, cell: GridCell, move: int, reward: float, reached: GridCell, next_move: int, terminated: bool
    ) -> float:
        settings = self.settings
        future = 0.0 if terminated else settings.gamma * float(self.values[reached].max())
        target = reward + future
        self.values[cell][move] += settings.alpha * (target - float(self.values[cell][move]))
        return target


def epsilon_greedy(values: FloatArray, epsilon: float, rng: np.random.Generator) -> int:
    """A best move by ``values`` (moves,), any one of several; with probability ``epsilon`` any move at all."""
    if rng.random() < epsilon:
        return int(rng.integers(len(values)))
    return int(rng.choice(np.flatnonzero(values >= values.max() - 1e-12)))
