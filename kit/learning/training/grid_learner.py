"""Q-learning and SARSA in a grid world, one update at a time, so that each can be shown.

The same two rules as ``tabular.py`` applies to many worlds at once (Sutton and Barto, Reinforcement Learning, 2nd
edition, sections 6.4 and 6.5).

A deep Q-network in a grid world, small enough to be watched: its values of all cells after each update.

The parts of DQN (Mnih and others, Nature 518, 2015), each of which can be taken away: a network in place of the table, a
replay buffer, and a target network. In numpy, since networks of this size are faster there than in torch.

Proximal policy optimisation in a grid world, small enough to be watched: the chances of all moves after each update.

The parts of PPO (Schulman and others, 2017), each of which can be taken away: several worlds at once, advantages by GAE,
the clipped ratio, and a bonus for entropy. Policy and critic are tables, so that nothing but these parts is seen.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Final, Literal, NamedTuple

import numpy as np

from kit.arrays import BoolArray, FloatArray, IntArray
from kit.learning.environment.grid_world import CLIFF, MOVES, TARGET, GridCell, GridWorld

MAX_EPISODE_STEPS: Final = 300
"""An episode that takes longer is truncated."""

GridAlgorithm = Literal["q-learning", "sarsa", "dqn", "ppo"]
TABLE_ALGORITHMS: Final[tuple[GridAlgorithm, ...]] = ("q-learning", "sarsa")
GRID_ALGORITHMS: Final[tuple[GridAlgorithm, ...]] = (*TABLE_ALGORITHMS, "dqn", "ppo")


@dataclass(frozen=True, slots=True)
class GridLearnerSettings:
    """How one learner learns."""

    algorithm: GridAlgorithm = "q-learning"
    alpha: float = 0.5
    """Learning rate: the part of the way to the target that a value goes, 0 to 1; of a network, Adam's."""
    gamma: float = 0.9
    """Discount: what a reward is worth one step earlier, 0 to 1."""
    epsilon: float = 0.1
    """Probability of a random move."""
    seed: int = 1
    replay: int = 1000
    """Steps that a network's replay buffer keeps; 1: none, it learns from the newest step alone."""
    target_interval: int = 50
    """Updates after which a network's targets come from its newest weights; 1: always."""
    worlds: int = 8
    """Worlds at once, of PPO."""
    clip: float = 0.2
    """How far PPO's ratio counts, from 1; 0: as far as it goes."""
    entropy: float = 0.01
    """What PPO pays for entropy."""
    temperature: float = 0.0
    """Moves are drawn in proportion to exp(value / temperature), in place of epsilon; 0: they are not."""
    value_limit: float = 0.0
    """For that draw, values beyond it count as much as it does; 0: there is none."""


@dataclass(frozen=True, slots=True)
class GridUpdate:
    """One update of one value."""

    cell: GridCell
    move: int
    reward: float
    reached: GridCell
    before: float
    target: float
    """What the value was moved towards."""
    after: float
    ended: bool
    """Whether the episode ended with this step."""


class GridLearner:
    """Learns step by step.

    >>> from kit.learning.environment.grid_world import GridWorld
    >>> learner = GridLearner(GridWorld(("SG",)), GridLearnerSettings(epsilon=0.0, alpha=0.5))
    >>> while learner.episodes < 3:
    ...     _ = learner.step()
    >>> float(learner.values[0, 0, 0])
    0.875
    """

    def __init__(self, world: GridWorld, settings: GridLearnerSettings) -> None:
        self.world = world
        self.settings = settings
        self.values: FloatArray = np.zeros((*world.shape, len(MOVES)))
        """(rows, columns, moves): the expected return of each move in each cell."""
        self.returns: list[float] = []
        """Sum of the rewards of each episode that has ended."""
        self.lengths: list[int] = []
        """Steps of each episode that has ended."""
        self.falls = 0
        """Episodes that ended on a cliff."""
        self.updates = 0
        self.cell = world.start
        self.last_update: GridUpdate | None = None
        self.episode_step = 0
        self._rng = np.random.default_rng(settings.seed)
        self._return = 0.0
        self._move = self._choose(self.cell)

    @property
    def episodes(self) -> int:
        """Episodes that have ended."""
        return len(self.returns)

    def step(self) -> GridUpdate:
        """Makes one move and learns from it."""
        cell, move = self.cell, self._move
        step = self.world.step(cell, move)
        next_move = self._choose(step.cell)
        before = float(self.values[cell][move])
        target = self._learn(cell, move, step.reward, step.cell, next_move, step.terminated)
        self.updates += 1
        self.episode_step += 1
        self._return += step.reward
        ended = step.terminated or self.episode_step >= MAX_EPISODE_STEPS
        self.last_update = GridUpdate(
            cell, move, step.reward, step.cell, before, target, float(self.values[cell][move]), ended
        )
        if ended:
            self.falls += self.world.sign(step.cell) == CLIFF
            self.returns.append(self._return)
            self.lengths.append(self.episode_step)
            self._return, self.episode_step, self.cell = 0.0, 0, self.world.start
            self._move = self._choose(self.cell)
        else:
            self.cell, self._move = step.cell, next_move
        return self.last_update

    def _learn(
        self, cell: GridCell, move: int, reward: float, reached: GridCell, next_move: int, terminated: bool
    ) -> float:
        """Learns from one step; returns the target."""
        settings, following = self.settings, self.values[reached]
        future = following.max() if settings.algorithm == "q-learning" else following[next_move]
        target = reward + (0.0 if terminated else settings.gamma * float(future))
        self.values[cell][move] += settings.alpha * (target - float(self.values[cell][move]))
        return target

    def describe_update(self) -> str:
        """Says in a few words what the last step paid and changed."""
        update = self.last_update
        if update is None:
            return "nothing is learned yet"
        return f"reward {update.reward:g}; old {update.before:.2f}, target {update.target:.2f}, new {update.after:.2f}"

    def greedy_move(self, cell: GridCell) -> int | None:
        """The best move in a cell; None where all are worth the same, as before anything was learned."""
        values = self.values[cell]
        return None if np.ptp(values) < 1e-12 else int(values.argmax())

    def greedy_path(self) -> tuple[GridCell, ...]:
        """The cells along the best moves from the start, until an end, a cell met before, or one without a best move."""
        cell, path = self.world.start, [self.world.start]
        while not self.world.is_terminal(cell):
            move = self.greedy_move(cell)
            if move is None:
                break
            cell = self.world.step(cell, move).cell
            if cell in path:
                break
            path.append(cell)
        return tuple(path)

    @property
    def is_solved(self) -> bool:
        """Whether the best moves lead from the start to the target."""
        return self.world.sign(self.greedy_path()[-1]) == TARGET

    def _choose(self, cell: GridCell) -> int:
        """A best move, any one of several; now and then any move at all. With a temperature: drawn by its value."""
        if self.settings.temperature > 0:
            values = self.values[cell]
            if self.settings.value_limit > 0:
                values = np.clip(values, -self.settings.value_limit, self.settings.value_limit)
            return _draw(softmax(values / self.settings.temperature), self._rng)
        if self._rng.random() < self.settings.epsilon:
            return int(self._rng.integers(len(MOVES)))
        values = self.values[cell]
        return int(self._rng.choice(np.flatnonzero(values >= values.max() - 1e-12)))


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
        return self._layers(inputs, self.parameters if parameters is None else parameters)[-1]

    def descend(self, inputs: FloatArray, moves: IntArray, targets: FloatArray, rate: float) -> None:
        """Makes one step of gradient descent (Adam) on the squared differences to the targets of the moves made."""
        first, second, values = self._layers(inputs, self.parameters)
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
    def _layers(
        inputs: FloatArray, parameters: list[FloatArray]
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        first = np.tanh(inputs @ parameters[0] + parameters[1])
        second = np.tanh(first @ parameters[2] + parameters[3])
        return first, second, second @ parameters[4] + parameters[5]


class NetworkLearner(GridLearner):
    """Learns with a network. One update changes the values of all cells at once, since all share the weights."""

    def __init__(self, world: GridWorld, settings: GridLearnerSettings) -> None:
        network_rng = np.random.default_rng((settings.seed, 1))
        rows, columns = world.shape
        places = np.indices(world.shape).reshape(2, -1).T / np.maximum(1, np.array((rows, columns)) - 1)
        self._inputs: FloatArray = places * 2.0 - 1.0
        """(cells, 2) row and column of every cell, each from -1 to 1."""
        self.network = ValueNetwork(network_rng, 2, len(MOVES))
        self.target_parameters = [each.copy() for each in self.network.parameters]
        """The parameters that targets are worked out by."""
        self._replay: list[ReplayedStep] = []
        self._sample_rng = network_rng
        super().__init__(world, settings)
        self._show_values()

    def _learn(
        self, cell: GridCell, move: int, reward: float, reached: GridCell, next_move: int, terminated: bool
    ) -> float:
        settings = self.settings
        own = ReplayedStep(
            self.world.number_of(cell), move, reward, self.world.number_of(reached), terminated
        )
        if len(self._replay) < settings.replay:
            self._replay.append(own)
        else:
            self._replay[self.updates % settings.replay] = own
        chosen = (
            [self._replay[at] for at in self._sample_rng.integers(len(self._replay), size=BATCH)]
            if settings.replay > 1
            else [own]
        )
        (target,) = self._targets([own])
        cells = np.array([each.cell for each in chosen])
        moves = np.array([each.move for each in chosen])
        self.network.descend(self._inputs[cells], moves, self._targets(chosen), settings.alpha)
        if (self.updates + 1) % settings.target_interval == 0:
            self.target_parameters = [each.copy() for each in self.network.parameters]
        self._show_values()
        return float(target)

    def _targets(self, steps: list[ReplayedStep]) -> FloatArray:
        reached = np.array([each.reached for each in steps])
        future = self.network.values(self._inputs[reached], self.target_parameters).max(axis=1)
        rewards = np.array([each.reward for each in steps])
        ended = np.array([each.terminated for each in steps])
        targets: FloatArray = rewards + np.where(ended, 0.0, self.settings.gamma * future)
        return targets

    def _show_values(self) -> None:
        self.values = self.network.values(self._inputs).reshape(self.values.shape)


HORIZON: Final = 16
"""Steps of each world between two updates."""
EPOCHS: Final = 10
"""Times that each batch of steps is learned from."""
GAE_LAMBDA: Final = 0.95
CRITIC_RATE: Final = 0.5
"""The part of the way to its target that a critic's value goes in an epoch."""


def softmax(logits: FloatArray) -> FloatArray:
    """Returns probabilities (..., n) that sum to 1, from any numbers (..., n)."""
    powers = np.exp(logits - logits.max(axis=-1, keepdims=True))
    chances: FloatArray = powers / powers.sum(axis=-1, keepdims=True)
    return chances


def _draw(chances: FloatArray, rng: np.random.Generator) -> int:
    """Draws one of ``n`` numbers by its chance (n,)."""
    return int(np.searchsorted(np.cumsum(chances)[:-1], rng.random()))


def advantages_of(
    rewards: FloatArray, values: FloatArray, next_values: FloatArray, ended: BoolArray, gamma: float
) -> FloatArray:
    """Generalised advantage estimates (steps, worlds). ``next_values``: of the states reached, 0 where terminated;
    ``ended``: where an episode ended, by whatever (Schulman and others, 2016)."""
    errors = rewards + gamma * next_values - values
    advantages, last = np.zeros_like(errors), np.zeros(errors.shape[1])
    for step in range(len(errors) - 1, -1, -1):
        last = errors[step] + gamma * GAE_LAMBDA * np.where(ended[step], 0.0, last)
        advantages[step] = last
    return advantages


class PolicyLearner(GridLearner):
    """Learns the chances of moves. ``values`` are these chances, so that arrows and numbers show the policy."""

    def __init__(self, world: GridWorld, settings: GridLearnerSettings) -> None:
        self.logits: FloatArray = np.zeros((world.shape[0] * world.shape[1], len(MOVES)))
        self.critic: FloatArray = np.zeros(len(self.logits))
        self._others = [world.start] * (settings.worlds - 1)
        self._other_steps = [0] * len(self._others)
        self._policy_rng = np.random.default_rng((settings.seed, 2))
        self._batch: list[tuple[IntArray, IntArray, FloatArray, IntArray, BoolArray, BoolArray]]
        self._batch = []
        super().__init__(world, settings)
        self._show_chances()

    def describe_update(self) -> str:
        update = self.last_update
        if update is None:
            return super().describe_update()
        chance = f"the chance of the move made was {update.before:.2f}"
        return f"reward {update.reward:g}; {chance}"

    def _choose(self, cell: GridCell) -> int:
        """Draws a move by its chance; there is no epsilon."""
        return self._draw(cell)

    def _draw(self, cell: GridCell) -> int:
        return _draw(softmax(self.logits[self.world.number_of(cell)]), self._policy_rng)

    def _learn(
        self, cell: GridCell, move: int, reward: float, reached: GridCell, next_move: int, terminated: bool
    ) -> float:
        ended = terminated or self.episode_step + 1 >= MAX_EPISODE_STEPS
        rows = [(self.world.number_of(cell), move, reward, self.world.number_of(reached), terminated, ended)]
        rows += [self._step_other(number) for number in range(len(self._others))]
        cells, moves, rewards, reaches, terminations, ends = zip(*rows, strict=True)
        self._batch.append(
            (
                np.array(cells),
                np.array(moves),
                np.array(rewards, dtype=float),
                np.array(reaches),
                np.array(terminations),
                np.array(ends),
            )
        )
        if len(self._batch) == HORIZON:
            self._update()
            self._batch.clear()
            self._show_chances()
        return float(
            reward + (0.0 if terminated else self.settings.gamma * self.critic[self.world.number_of(reached)])
        )

    def _step_other(self, number: int) -> tuple[int, int, float, int, bool, bool]:
        """One step of another world."""
        cell = self._others[number]
        move = self._draw(cell)
        step = self.world.step(cell, move)
        self._other_steps[number] += 1
        ended = step.terminated or self._other_steps[number] >= MAX_EPISODE_STEPS
        self._others[number] = self.world.start if ended else step.cell
        if ended:
            self._other_steps[number] = 0
        return (
            self.world.number_of(cell),
            move,
            step.reward,
            self.world.number_of(step.cell),
            step.terminated,
            ended,
        )

    def _update(self) -> None:
        settings = self.settings
        cells, moves, rewards, reached, terminated, ended = (
            np.array(part) for part in zip(*self._batch, strict=True)
        )
        values = self.critic[cells]
        next_values = np.where(terminated, 0.0, self.critic[reached])
        advantages = advantages_of(rewards, values, next_values, ended, settings.gamma)
        returns = (advantages + values).ravel()
        weights = ((advantages - advantages.mean()) / (advantages.std() + 1e-8)).ravel()
        cells, moves = cells.ravel(), moves.ravel()
        old = softmax(self.logits[cells])[np.arange(len(cells)), moves]
        for _ in range(EPOCHS):
            self._climb(cells, moves, weights, old)
            totals, counts = np.zeros(len(self.critic)), np.zeros(len(self.critic))
            np.add.at(totals, cells, returns - self.critic[cells])
            np.add.at(counts, cells, 1.0)
            self.critic += CRITIC_RATE * totals / np.maximum(1.0, counts)

    def _climb(self, cells: IntArray, moves: IntArray, weights: FloatArray, old: FloatArray) -> None:
        """One step up the clipped objective, with the bonus for entropy."""
        settings, rows = self.settings, np.arange(len(cells))
        chances = softmax(self.logits[cells])
        ratio = chances[rows, moves] / np.maximum(old, 1e-12)
        if settings.clip > 0:
            # Outside the clip range the objective is flat where it would gain, so there is no slope.
            is_flat = ((weights > 0) & (ratio > 1 + settings.clip)) | (
                (weights < 0) & (ratio < 1 - settings.clip)
            )
            weights = np.where(is_flat, 0.0, weights)
        one_hot = np.zeros_like(chances)
        one_hot[rows, moves] = 1.0
        slope = (weights * ratio)[:, None] * (one_hot - chances)
        logs = np.log(chances + 1e-12)
        entropy = -(chances * logs).sum(axis=1, keepdims=True)
        slope -= settings.entropy * chances * (logs + entropy)
        totals, counts = np.zeros_like(self.logits), np.zeros(len(self.logits))
        np.add.at(totals, cells, slope)
        np.add.at(counts, cells, 1.0)
        self.logits += settings.alpha * totals / np.maximum(1.0, counts)[:, None]

    def _show_chances(self) -> None:
        self.values = softmax(self.logits).reshape(self.values.shape)
