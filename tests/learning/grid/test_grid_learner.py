"""Small learners on a grid: tables as in the books, a network with its parts, and PPO with its clipping."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from kit.learning.grid.chances import softmax
from kit.learning.grid.dqn import DqnLearner, ValueNetwork
from kit.learning.grid.grid_learner import MAX_EPISODE_STEPS, GridLearnerSettings
from kit.learning.grid.grid_world import GridRewards, GridWorld
from kit.learning.grid.ppo import GAE_LAMBDA, PpoLearner, advantages_of
from kit.learning.grid.registry import make_grid_learner
from tests.learning.worlds import trained

CLIFF = GridWorld((*("........",) * 3, "SCCCCCCG"), GridRewards(-1, -1, 0, -100))


@pytest.mark.parametrize("algorithm", ["q-learning", "sarsa"])
def test_each_update_goes_alpha_of_the_way_to_its_target(algorithm: str) -> None:
    """The target is worked out again from the table before the update; SARSA's from the move that comes next."""
    settings = GridLearnerSettings(algorithm, alpha=0.25, gamma=0.8, epsilon=0.3, seed=4)
    learner = make_grid_learner(CLIFF, settings)
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
    for algorithm in ("q-learning", "sarsa"):
        learner = trained(CLIFF, GridLearnerSettings(algorithm, 0.5, 1.0, 0.1, seed=3), 300)
        assert learner.is_solved
        lengths[algorithm] = len(learner.greedy_path()) - 1
        falls[algorithm] = sum(each <= -100 for each in learner.returns)
    assert lengths["q-learning"] == CLIFF.shortest_path_length
    assert lengths["sarsa"] > lengths["q-learning"]
    assert falls["sarsa"] < falls["q-learning"]


def test_an_episode_that_never_ends_is_truncated_and_its_estimate_counts() -> None:
    world = GridWorld(("S" + "." * 30 + "G",), GridRewards(step=-1))
    learner = make_grid_learner(world, GridLearnerSettings(epsilon=1.0, seed=2))
    while True:
        update = learner.step()
        if update.ended:
            break
    assert learner.lengths == [MAX_EPISODE_STEPS]
    assert update.target != update.reward


WORLD = GridWorld(("..#...G", "..#.#..", "....#..", "S......"), GridRewards(step=-0.05))


def settings(**changes: int) -> GridLearnerSettings:
    return GridLearnerSettings("dqn", alpha=0.01, gamma=0.9, epsilon=0.2, seed=0, **changes)  # type: ignore[arg-type]  # all are whole numbers


def test_the_gradient_is_that_of_the_squared_error() -> None:
    """Adam's first step goes against each gradient's sign: compared with differences of the loss."""
    rng = np.random.default_rng(3)
    network = ValueNetwork(rng, 2, 4)
    inputs, moves, targets = rng.normal(size=(5, 2)), rng.integers(4, size=5), rng.normal(size=5)

    def loss(parameters: list[np.ndarray]) -> float:
        values = network.values(inputs, parameters)[np.arange(5), moves]
        return float(((values - targets) ** 2).mean())

    before = [each.copy() for each in network.parameters]
    network.descend(inputs, moves, targets, rate=0.001)
    for number, parameter in enumerate(before):
        at = tuple(int(each) for each in rng.integers(parameter.shape))
        nudged = [each.copy() for each in before]
        nudged[number][at] += 1e-6
        slope = (loss(nudged) - loss(before)) / 1e-6
        moved = network.parameters[number][at] - parameter[at]
        assert moved == pytest.approx(-0.001 * np.sign(slope), abs=2e-4), number


def test_one_update_changes_the_values_of_every_cell() -> None:
    learner = DqnLearner(WORLD, settings())
    before = learner.values.copy()
    learner.step()
    assert (learner.values != before).all()


def test_targets_rest_between_two_copies_of_the_network() -> None:
    learner = DqnLearner(WORLD, settings(target_interval=10))
    kept = [each.copy() for each in learner.target_parameters]
    for _ in range(9):
        learner.step()
    assert all((one == other).all() for one, other in zip(kept, learner.target_parameters, strict=True))
    learner.step()
    newest = zip(learner.network.parameters, learner.target_parameters, strict=True)
    assert all((one == other).all() for one, other in newest)


@pytest.mark.long
def test_it_learns_the_way_with_all_its_parts_and_not_without_a_buffer() -> None:
    solved = {}
    for replay in (1000, 1):
        learner, counts = DqnLearner(WORLD, settings(replay=replay)), []
        while learner.updates < 2000:
            ended = learner.step().ended
            if ended:
                counts.append(learner.is_solved)
        solved[replay] = sum(counts[-20:])
    assert solved[1000] >= 18
    assert solved[1] <= 5


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
    learner = PpoLearner(WORLD, replace(SETTINGS, clip=clip, entropy=0.1, alpha=1e-3))
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
    learner._ascend_objective(cells, moves, weights, old)
    for cell in range(5):
        for move in range(4):
            nudged = before.copy()
            nudged[cell, move] += 1e-6
            slope = (objective(nudged, cell) - objective(before, cell)) / 1e-6
            assert (learner.logits - before)[cell, move] == pytest.approx(1e-3 * slope, abs=1e-6)


def test_every_number_shown_is_a_chance() -> None:
    learner = PpoLearner(WORLD, SETTINGS)
    for _ in range(100):
        learner.step()
    assert learner.values.sum(axis=-1) == pytest.approx(np.ones(WORLD.shape))
    assert (learner.values >= 0).all()


@pytest.mark.long
def test_without_clipping_it_gets_stuck() -> None:
    solved = {}
    for clip in (0.2, 0.0):
        learner = PpoLearner(WORLD, replace(SETTINGS, clip=clip))
        while learner.updates < 1500:
            learner.step()
        solved[clip] = learner.is_solved
    assert solved == {0.2: True, 0.0: False}
