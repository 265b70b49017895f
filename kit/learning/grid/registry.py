"""The learners in a grid world by the names of their algorithms."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

from kit.learning.grid.dqn import DqnLearner
from kit.learning.grid.grid_learner import GridLearner, GridLearnerSettings
from kit.learning.grid.grid_world import GridWorld
from kit.learning.grid.ppo import PpoLearner
from kit.learning.grid.q_learning import QLearner
from kit.learning.grid.sarsa import SarsaLearner

GRID_LEARNERS: Final[Mapping[str, type[GridLearner]]] = MappingProxyType(
    {learner.algorithm: learner for learner in (QLearner, SarsaLearner, DqnLearner, PpoLearner)}
)


def make_grid_learner(world: GridWorld, settings: GridLearnerSettings) -> GridLearner:
    """The learner that the settings name."""
    return GRID_LEARNERS[settings.algorithm](world, settings)
