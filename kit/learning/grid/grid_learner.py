"""The contract of the learners in a grid world: one step and one update at a time, so that each can be shown."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar, Final

import numpy as np

from kit.arrays import FloatArray
from kit.learning.grid.grid_world import CLIFF, MOVE_NAMES, TARGET, GridCell, GridWorld

MAX_EPISODE_STEPS: Final = 300
"""An episode that takes longer is truncated."""


@dataclass(frozen=True, slots=True)
class GridLearnerSettings:
    """How one learner learns."""

    algorithm: str = "q-learning"
    """The name of a learner."""
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
class ValueUpdate:
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


class GridLearner(ABC):
    """Makes a step and learns from it, again and again; the algorithm is a subclass."""

    algorithm: ClassVar[str]
    """Its name in lessons."""

    def __init__(self, world: GridWorld, settings: GridLearnerSettings) -> None:
        self.world = world
        self.settings = settings
        self.values: FloatArray = np.zeros((*world.shape, len(MOVE_NAMES)))
        """(rows, columns, moves): the expected return of each move in each cell."""
        self.returns: list[float] = []
        """Sum of the rewards of each episode that has ended."""
        self.lengths: list[int] = []
        """Steps of each episode that has ended."""
        self.falls = 0
        """Episodes that ended on a cliff."""
        self.updates = 0
        self.cell = world.start
        self.last_update: ValueUpdate | None = None
        self.episode_step = 0
        self.rng = np.random.default_rng(settings.seed)
        self._return = 0.0
        self._move = self.choose(self.cell)

    @property
    def episodes(self) -> int:
        """Episodes that have ended."""
        return len(self.returns)

    def step(self) -> ValueUpdate:
        """Makes one move and learns from it."""
        cell, move = self.cell, self._move
        step = self.world.step(cell, move)
        next_move = self.choose(step.cell)
        before = float(self.values[cell][move])
        target = self.learn(cell, move, step.reward, step.cell, next_move, step.terminated)
        self.updates += 1
        self.episode_step += 1
        self._return += step.reward
        ended = step.terminated or self.episode_step >= MAX_EPISODE_STEPS
        self.last_update = ValueUpdate(
            cell, move, step.reward, step.cell, before, target, float(self.values[cell][move]), ended
        )
        if ended:
            self.falls += self.world.sign(step.cell) == CLIFF
            self.returns.append(self._return)
            self.lengths.append(self.episode_step)
            self._return, self.episode_step, self.cell = 0.0, 0, self.world.start
            self._move = self.choose(self.cell)
        else:
            self.cell, self._move = step.cell, next_move
        return self.last_update

    @abstractmethod
    def choose(self, cell: GridCell) -> int:
        """Returns the move that it makes in a cell."""

    @abstractmethod
    def learn(
        self, cell: GridCell, move: int, reward: float, reached: GridCell, next_move: int, terminated: bool
    ) -> float:
        """Learns from one step, after which ``next_move`` is made; returns what the value was moved towards."""

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
