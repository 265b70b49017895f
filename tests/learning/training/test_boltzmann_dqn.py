"""The dissertation's agent: its network's gradient, its draws, what a checkpoint brings back."""

from __future__ import annotations

from types import ModuleType
from typing import TYPE_CHECKING

import numpy as np
import pytest

if TYPE_CHECKING:
    from kit.learning.training.boltzmann_dqn import ReplayBatch

RNG = np.random.default_rng(3)


@pytest.fixture
def dqn() -> ModuleType:
    """The module under test, which imports torch: a second for every process that only collects the tests."""
    import kit.learning.training.boltzmann_dqn

    return kit.learning.training.boltzmann_dqn


def batch(dqn: ModuleType, count: int = 8, inputs: int = 5) -> ReplayBatch:
    return dqn.ReplayBatch(
        RNG.normal(size=(count, inputs)).astype(np.float32),
        RNG.integers(3, size=count),
        RNG.normal(size=count).astype(np.float32),
        RNG.random(count) < 0.5,
        RNG.normal(size=(count, inputs)).astype(np.float32),
    )


@pytest.mark.parametrize("activation", ["relu", "tanh"])
def test_the_gradient_is_that_of_half_the_squared_error(dqn: ModuleType, activation: str) -> None:
    network = dqn.QNetwork((5, 6, 4, 3), activation, np.random.default_rng(0))  # type: ignore[arg-type]  # both are
    steps, targets = batch(dqn), RNG.normal(size=8).astype(np.float32)
    start = network.parameters.copy()
    found: list[np.ndarray[tuple[int], np.dtype[np.float32]]] = []
    network._adam_step = lambda gradient, rate: found.append(gradient.copy())  # type: ignore[method-assign]  # only look
    network.descend(steps, targets, 0.1)

    def loss(parameters: np.ndarray[tuple[int], np.dtype[np.float32]]) -> float:
        values = network.outputs(steps.seen, parameters)[-1][np.arange(8), steps.actions]
        return float(0.5 * np.mean((values - targets) ** 2))

    for place in range(0, len(start), 7):
        moved = np.array([start, start])
        moved[0, place] += 1e-2
        moved[1, place] -= 1e-2
        slope = (loss(moved[0]) - loss(moved[1])) / 2e-2
        assert found[0][place] == pytest.approx(slope, abs=5e-3)


def test_gradient_descent_comes_to_its_targets(dqn: ModuleType) -> None:
    network = dqn.QNetwork((5, 24, 3), "relu", np.random.default_rng(0))
    steps, targets = batch(dqn), np.linspace(-1, 1, 8, dtype=np.float32)
    for _ in range(600):
        network.descend(steps, targets, 0.01)
    assert network.outputs(steps.seen)[-1][np.arange(8), steps.actions] == pytest.approx(targets, abs=0.05)


def test_the_buffer_keeps_the_last_steps_and_comes_back_from_a_file(dqn: ModuleType) -> None:
    buffer, steps = dqn.ReplayBuffer(5, 5), batch(dqn)
    for number in range(8):
        buffer.add(dqn.ReplayBatch(*(array[number : number + 1] for array in steps)))
    again = dqn.ReplayBuffer(5, 5)
    again.load(buffer.save(), 3)
    assert again.filled == 5
    drawn = again.sample(np.random.default_rng(0), 200)
    assert set(drawn.rewards.tolist()) == set(steps.rewards[3:].tolist())
    at = {float(reward): number for number, reward in enumerate(steps.rewards)}
    for number, reward in enumerate(drawn.rewards):
        assert (drawn.seen[number] == steps.seen[at[float(reward)]]).all()
