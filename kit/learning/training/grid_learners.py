"""Finds the learner of a grid world that settings name."""

from __future__ import annotations

from kit.learning.environment.grid_world import GridWorld
from kit.learning.training.grid_learner import GridLearner, GridLearnerSettings
from kit.learning.training.grid_network import NetworkLearner
from kit.learning.training.grid_ppo import PolicyLearner


def make_grid_learner(world: GridWorld, settings: GridLearnerSettings) -> GridLearner:
    """Makes the learner that the settings name: with a table, with a network, or of a policy."""
    classes: dict[str, type[GridLearner]] = {"dqn": NetworkLearner, "ppo": PolicyLearner}
    return classes.get(settings.algorithm, GridLearner)(world, settings)
