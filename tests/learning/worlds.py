"""Transitions and worlds for the tests of learning."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields, replace
from functools import cache

import numpy as np

from kit.arrays import IntArray
from kit.learning.environment.batch import BatchEnv
from kit.learning.environment.batch_state import BatchStep
from kit.learning.grid.grid_learner import GridLearner, GridLearnerSettings
from kit.learning.grid.grid_world import GridWorld
from kit.learning.grid.registry import make_grid_learner
from kit.learning.tasks.actions import Move
from kit.learning.tasks.catalogue import HALLWAY, TURN, WHEELCHAIRS, WHEELCHAIRS_SEED
from kit.learning.tasks.learning_task import LearningTask
from kit.learning.tasks.transition import EpisodeState, Transition

TASKS = {"turn": TURN, "hallway": HALLWAY, "wheelchairs": WHEELCHAIRS}
"""One of each kind."""
THREE_MOVES, SEVEN_MOVES, FOUR_MOVES = TURN.actions, HALLWAY.actions, WHEELCHAIRS_SEED.actions
NINE_NUMBERS, SEVENTEEN_NUMBERS = TURN.observation, HALLWAY.observation
NINETEEN_NUMBERS = WHEELCHAIRS_SEED.observation


def actions_of(batch: BatchEnv, chance: np.random.Generator) -> IntArray:
    """Any actions, one for each world."""
    robots = batch.task.robots
    numbers = chance.integers(len(batch.task.actions.moves), size=(batch.n, robots))
    if not batch.task.actions.one_number:
        return numbers
    return numbers @ len(batch.task.actions.moves) ** np.arange(robots - 1, -1, -1)


def steps(batch: BatchEnv, count: int, seed: int = 0) -> Iterator[BatchStep]:
    """What so many steps of chance give."""
    chance = np.random.default_rng(seed)
    for _ in range(count):
        yield batch.step(actions_of(batch, chance))


@cache
def sampled(name: str) -> Transition:
    """Some thousand transitions, among them every way in which an episode ends."""
    task = replace(TASKS[name], max_steps=25, target_radius=1.5 if name == "turn" else 1.0)
    batch, chance = BatchEnv(task, 60, seed=5), np.random.default_rng(0)
    batch.reset()
    ahead = np.full((60, task.robots), task.actions.moves.index(Move.FORWARD))
    found = []
    for _ in range(80):
        actions = actions_of(batch, chance).reshape(60, -1)
        found.append(
            batch.step(np.where(np.arange(60)[:, None] % 3 == 0, ahead, actions).squeeze()).transition
        )
    return joined(found)


def joined(transitions: list[Transition]) -> Transition:
    """Those of all of them, one after the other."""
    before, after = (
        EpisodeState(
            *(
                np.concatenate([getattr(each, field.name) for each in states])
                for field in fields(EpisodeState)
            )
        )
        for states in ([each.before for each in transitions], [each.after for each in transitions])
    )
    return replace(transitions[0], before=before, after=after)


COMMON_FIELDS = ("max_steps", "collision_ends", "robots")
"""Facts of a transition that are the same for all worlds."""


def short(task: LearningTask, case: str) -> LearningTask:
    """The task on one case."""
    return replace(task, cases=(case,))


def trained(world: GridWorld, settings: GridLearnerSettings, episodes: int) -> GridLearner:
    """A learner after so many episodes."""
    learner = make_grid_learner(world, settings)
    while learner.episodes < episodes:
        learner.step()
    return learner
