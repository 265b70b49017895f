"""Tables that learn one update at a time: the books' updates, and what they lead to."""

from __future__ import annotations

import numpy as np
import pytest

from kit.learning.environment.grid_world import GridRewards, GridWorld
from kit.learning.training.grid_learner import (
    MAX_EPISODE_STEPS,
    TABLE_ALGORITHMS,
    GridAlgorithm,
    GridLearner,
    GridLearnerSettings,
)

CLIFF = GridWorld((*("........",) * 3, "SCCCCCCG"), GridRewards(-1, -1, 0, -100))


def trained(world: GridWorld, settings: GridLearnerSettings, episodes: int) -> GridLearner:
    learner = GridLearner(world, settings)
    while learner.episodes < episodes:
        learner.step()
    return learner


@pytest.mark.parametrize("algorithm", TABLE_ALGORITHMS)
def test_each_update_goes_alpha_of_the_way_to_its_target(algorithm: GridAlgorithm) -> None:
    """The target is worked out again from the table before the update; SARSA's from the move that comes next."""
    settings = GridLearnerSettings(algorithm, alpha=0.25, gamma=0.8, epsilon=0.3, seed=4)
    learner = GridLearner(CLIFF, settings)
    before, first = learner.values.copy(), learner.step()
    for _ in range(2000):
        kept = learner.values.copy()
        second = learner.step()
        following = before[first.reached]
        if first.ended:
            target = first.reward
        elif algorithm == "sarsa":
            target = first.reward + 0.8 * following[second.move]
        else:
            target = first.reward + 0.8 * following.max()
        assert first.target == pytest.approx(target)
        assert first.after == pytest.approx(first.before + 0.25 * (first.target - first.before))
        changed = np.argwhere(kept != before)
        assert len(changed) <= 1
        before, first = kept, second


def test_the_values_become_those_of_the_bellman_equation() -> None:
    """Exploring all the time, Q-learning finds what the best moves are worth: 0.9 to the power of the steps left."""
    world = GridWorld(("..#G", "S..."), GridRewards())
    learner = trained(world, GridLearnerSettings(epsilon=1.0, alpha=0.5, gamma=0.9), 400)
    assert learner.values[1, 0].max() == pytest.approx(0.9**3, abs=1e-6)
    assert learner.is_solved
    assert len(learner.greedy_path()) - 1 == world.shortest_path_length


def test_sarsa_keeps_away_from_the_cliff_and_q_learning_does_not() -> None:
    lengths, falls = {}, {}
    for algorithm in TABLE_ALGORITHMS:
        learner = trained(CLIFF, GridLearnerSettings(algorithm, 0.5, 1.0, 0.1, seed=3), 300)
        assert learner.is_solved
        lengths[algorithm] = len(learner.greedy_path()) - 1
        falls[algorithm] = sum(each <= -100 for each in learner.returns)
    assert lengths["q-learning"] == CLIFF.shortest_path_length
    assert lengths["sarsa"] > lengths["q-learning"]
    assert falls["sarsa"] < falls["q-learning"]


def test_an_episode_that_never_ends_is_truncated_and_its_estimate_counts() -> None:
    world = GridWorld(("S" + "." * 30 + "G",), GridRewards(step=-1))
    learner = GridLearner(world, GridLearnerSettings(epsilon=1.0, seed=2))
    while True:
        update = learner.step()
        if update.ended:
            break
    assert learner.lengths == [MAX_EPISODE_STEPS]
    assert update.target != update.reward
