"""A small DQN: its gradients, what each of its parts is for, and that one update changes every cell."""

from __future__ import annotations

import numpy as np
import pytest

from kit.learning.environment.grid_world import GridRewards, GridWorld
from kit.learning.training.grid_learner import GridLearnerSettings, NetworkLearner, ValueNetwork

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
    learner = NetworkLearner(WORLD, settings())
    before = learner.values.copy()
    learner.step()
    assert (learner.values != before).all()


def test_targets_rest_between_two_copies_of_the_network() -> None:
    learner = NetworkLearner(WORLD, settings(target_interval=10))
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
        learner, counts = NetworkLearner(WORLD, settings(replay=replay)), []
        while learner.updates < 2000:
            ended = learner.step().ended
            if ended:
                counts.append(learner.is_solved)
        solved[replay] = sum(counts[-20:])
    assert solved[1000] >= 18
    assert solved[1] <= 5
