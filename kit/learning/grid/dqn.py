"""A deep Q-network in a grid world, small enough to be watched: its values of all cells after each update.

The parts of DQN (Mnih and others, Nature 518, 2015), each of which can be taken away: a network in place of the table, a
replay buffer, and a target network. In numpy, since networks of this size are faster there than in torch.
"""

from __future__ import annotations

from itertools import pairwise
from typing import ClassVar, Final, NamedTuple

import numpy as np

from kit.arrays import FloatArray, IntArray
from kit.learning.grid.grid_learner import GridLearner, GridLearnerSettings
from kit.learning.grid.grid_world import MOVE_NAMES, GridCell, GridWorld
from kit.learning.grid.q_learning import choose_by_values

HIDDEN: Final = 32
"""Neurons of each of the two hidden layers."""
BATCH: Final = 32
"""Steps that one update learns from, where there is a replay buffer."""
ADAM_DECAY: Final = (0.9, 0.999)
ADAM_EPSILON: Final = 1e-8


class ReplayedStep(NamedTuple):
    """One step, as the replay buffer keeps it."""

    cell: int
    move: int
    reward: float
    reached: int
    terminated: bool


class ValueNetwork:
    """A network with two hidden layers that gives the values of all moves for a cell's row and column."""

    def __init__(self, rng: np.random.Generator, inputs: int, outputs: int) -> None:
        sizes = (inputs, HIDDEN, HIDDEN, outputs)
        self.parameters: list[FloatArray] = []
        """Weights and biases, layer by layer."""
        for rows, columns in pairwise(sizes):
            self.parameters += [rng.normal(0, 1 / np.sqrt(rows), (rows, columns)), np.zeros(columns)]
        self.parameters[-2] *= 0.1  # the values begin near 0
        self._means = [np.zeros_like(each) for each in self.parameters]
        self._squares = [np.zeros_like(each) for each in self.parameters]
        self._updates = 0

    def values(self, inputs: FloatArray, parameters: list[FloatArray] | None = None) -> FloatArray:
        """(n, outputs) values for (n, inputs); by other parameters if they are given."""
        return self._forward(inputs, self.parameters if parameters is None else parameters)[-1]

    def descend(self, inputs: FloatArray, moves: IntArray, targets: FloatArray, rate: float) -> None:
        """Makes one step of gradient descent (Adam) on the squared differences to the targets of the moves made."""
        first, second, values = self._forward(inputs, self.parameters)
        rows = np.arange(len(moves))
        slope = np.zeros_like(values)
        slope[rows, moves] = 2 * (values[rows, moves] - targets) / len(moves)
        weights = self.parameters[::2]
        slope_second = slope @ weights[2].T * (1 - second**2)
        slope_first = slope_second @ weights[1].T * (1 - first**2)
        gradients = [
            inputs.T @ slope_first,
            slope_first.sum(axis=0),
            first.T @ slope_second,
            slope_second.sum(axis=0),
            second.T @ slope,
            slope.sum(axis=0),
        ]
        self._updates += 1
        one, other = ADAM_DECAY
        scale = rate * np.sqrt(1 - other**self._updates) / (1 - one**self._updates)
        for parameter, gradient, mean, square in zip(
            self.parameters, gradients, self._means, self._squares, strict=True
        ):
            mean += (1 - one) * (gradient - mean)
            square += (1 - other) * (gradient**2 - square)
            parameter -= scale * mean / (np.sqrt(square) + ADAM_EPSILON)

    @staticmethod
    def _forward(
        inputs: FloatArray, parameters: list[FloatArray]
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        first = np.tanh(inputs @ parameters[0] + parameters[1])
        second = np.tanh(first @ parameters[2] + parameters[3])
        return first, second, second @ parameters[4] + parameters[5]


class DqnLearner(GridLearner):
    """Learns with a network. One update changes the values of all cells at once, since all share the weights."""

    algorithm: ClassVar[str] = "dqn"

    def __init__(self, world: GridWorld, settings: GridLearnerSettings) -> None:
        network_rng = np.random.default_rng((settings.seed, 1))
        rows, columns = world.shape
        places = np.indices(world.shape).reshape(2, -1).T / np.maximum(1, np.array((rows, columns)) - 1)
        self._inputs: FloatArray = places * 2.0 - 1.0
        """(cells, 2) row and column of every cell, each from -1 to 1."""
        self.network = ValueNetwork(network_rng, 2, len(MOVE_NAMES))
        self.target_parameters = [each.copy() for each in self.network.parameters]
        """The parameters that targets are worked out by."""
        self._replay: list[ReplayedStep] = []
        """The replay buffer."""
        self._sample_rng = network_rng
        super().__init__(world, settings)
        self._show_values()

    def choose(self, cell: GridCell) -> int:
        return choose_by_values(self.values[cell], self.settings, self.rng)

    def learn(
        self, cell: GridCell, move: int, reward: float, reached: GridCell, next_move: int, terminated: bool
    ) -> float:
        settings = self.settings
        own = ReplayedStep(
            self.world.number_of(cell), move, reward, self.world.number_of(reached), terminated
        )
        self.store(own)
        chosen = (
            [self._replay[at] for at in self._sample_rng.integers(len(self._replay), size=BATCH)]
            if settings.replay > 1
            else [own]
        )
        (target,) = self.targets([own])
        cells = np.array([each.cell for each in chosen])
        moves = np.array([each.move for each in chosen])
        self.network.descend(self._inputs[cells], moves, self.targets(chosen), settings.alpha)
        self.synchronise()
        self._show_values()
        return float(target)

    def store(self, step: ReplayedStep) -> None:
        """Puts a step into the replay buffer, in the place of the oldest once it is full."""
        if len(self._replay) < self.settings.replay:
            self._replay.append(step)
        else:
            self._replay[self.updates % self.settings.replay] = step

    def synchronise(self) -> None:
        """Renews the copy that targets are worked out by, when it is time."""
        if (self.updates + 1) % self.settings.target_interval == 0:
            self.target_parameters = [each.copy() for each in self.network.parameters]

    def next_values(self, steps: list[ReplayedStep]) -> FloatArray:
        """(steps, moves): the values in the states that the steps led to, by the target network."""
        reached = np.array([each.reached for each in steps])
        return self.network.values(self._inputs[reached], self.target_parameters)

    def targets(self, steps: list[ReplayedStep]) -> FloatArray:
        """(steps,): what the values of the moves made are moved towards."""
        future = self.next_values(steps).max(axis=1)
        rewards = np.array([each.reward for each in steps])
        ended = np.array([each.terminated for each in steps])
        targets: FloatArray = rewards + np.where(ended, 0.0, self.settings.gamma * future)
        return targets

    def _show_values(self) -> None:
        self.values = self.network.values(self._inputs).reshape(self.values.shape)
