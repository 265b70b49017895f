"""A small PPO: advantages by hand, the slope of its objective, and what clipping and several worlds are for."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from kit.learning.environment.grid_world import GridRewards, GridWorld
from kit.learning.training.grid_learner import (
    GAE_LAMBDA,
    GridLearnerSettings,
    PolicyLearner,
    advantages_of,
    softmax,
)

WORLD = GridWorld(("..#...G", "..#.#..", "....#..", "S......"), GridRewards(step=-0.05))
SETTINGS = GridLearnerSettings("ppo", alpha=3.0, gamma=0.95, seed=1)


def test_advantages_add_up_errors_until_the_episode_ends() -> None:
    rewards, values = np.array([[1.0], [2.0], [3.0]]), np.array([[0.5], [0.25], [0.0]])
    reached = np.array([[0.25], [0.0], [4.0]])
    found = advantages_of(rewards, values, reached, np.array([[False], [True], [False]]), 0.9)
    errors = [1 + 0.9 * 0.25 - 0.5, 2 - 0.25, 3 + 0.9 * 4]
    assert found[:, 0] == pytest.approx([errors[0] + 0.9 * GAE_LAMBDA * errors[1], errors[1], errors[2]])


@pytest.mark.parametrize("clip", [0.0, 0.2])
def test_an_update_goes_up_the_slope_of_the_clipped_objective(clip: float) -> None:
    """Compared with differences of the objective, cell by cell."""
    learner = PolicyLearner(WORLD, replace(SETTINGS, clip=clip, entropy=0.1, alpha=1e-3))
    rng = np.random.default_rng(2)
    learner.logits[:] = rng.normal(size=learner.logits.shape)
    cells, moves, weights = rng.integers(5, size=40), rng.integers(4, size=40), rng.normal(size=40)
    chances = softmax(learner.logits[cells])[np.arange(40), moves]
    old = chances * rng.uniform(0.7, 1.4, size=40)

    def objective(logits: np.ndarray, cell: int) -> float:
        own = cells == cell
        probabilities = softmax(logits[cells[own]])
        ratio = probabilities[np.arange(own.sum()), moves[own]] / old[own]
        gain = ratio * weights[own]
        if clip:
            gain = np.minimum(gain, np.clip(ratio, 1 - clip, 1 + clip) * weights[own])
        entropy = -(probabilities * np.log(probabilities)).sum(axis=1)
        return float((gain + 0.1 * entropy).mean())

    before = learner.logits.copy()
    learner._climb(cells, moves, weights, old)
    for cell in range(5):
        for move in range(4):
            nudged = before.copy()
            nudged[cell, move] += 1e-6
            slope = (objective(nudged, cell) - objective(before, cell)) / 1e-6
            assert (learner.logits - before)[cell, move] == pytest.approx(1e-3 * slope, abs=1e-6)


def test_every_number_shown_is_a_chance() -> None:
    learner = PolicyLearner(WORLD, SETTINGS)
    for _ in range(100):
        learner.step()
    assert learner.values.sum(axis=-1) == pytest.approx(np.ones(WORLD.shape))
    assert (learner.values >= 0).all()


@pytest.mark.long
def test_without_clipping_it_gets_stuck() -> None:
    solved = {}
    for clip in (0.2, 0.0):
        learner = PolicyLearner(WORLD, replace(SETTINGS, clip=clip))
        while learner.updates < 1500:
            learner.step()
        solved[clip] = learner.is_solved
    assert solved == {0.2: True, 0.0: False}
