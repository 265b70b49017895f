"""Q-learning in a grid world: a table of values, and one rule that changes one of them after each step.

The same rule as ``training/tabular.py`` applies to many worlds at once (Sutton and Barto, Reinforcement Learning, 2nd
edition, section 6.5).
"""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from kit.arrays import FloatArray
from kit.learning.grid.chances import draw, softmax
from kit.learning.grid.grid_learner import GridLearner, GridLearnerSettings
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
        return choose_by_values(self.values[cell], self.settings, self.rng)

    def learn(
        self, cell: GridCell, move: int, reward: float, reached: GridCell, next_move: int, terminated: bool
    ) -> float:
        settings = self.settings
        future = 0.0 if terminated else settings.gamma * float(self.values[reached].max())
        target = reward + future
        self.values[cell][move] += settings.alpha * (target - float(self.values[cell][move]))
        return target


def choose_by_values(values: FloatArray, settings: GridLearnerSettings, rng: np.random.Generator) -> int:
    """A best move by ``values`` (moves,), any one of several; now and then any move at all. With a temperature: drawn by
    its value."""
    if settings.temperature > 0:
        limit = settings.value_limit
        limited = np.clip(values, -limit, limit) if limit > 0 else values
        return draw(softmax(limited / settings.temperature), rng)
    if rng.random() < settings.epsilon:
        return int(rng.integers(len(values)))
    return int(rng.choice(np.flatnonzero(values >= values.max() - 1e-12)))
