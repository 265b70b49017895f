"""Proximal policy optimisation in a grid world, small enough to be watched: the chances of all moves after each update.

The parts of PPO (Schulman and others, 2017), each of which can be taken away: several worlds at once, advantages by GAE,
the clipped ratio, and a bonus for entropy. Policy and critic are tables, so that nothing but these parts is seen.
"""

from __future__ import annotations

from typing import ClassVar, Final

import numpy as np

from kit.arrays import BoolArray, FloatArray, IntArray
from kit.learning.grid.chances import draw, softmax
from kit.learning.grid.grid_learner import MAX_EPISODE_STEPS, GridLearner, GridLearnerSettings
from kit.learning.grid.grid_world import MOVE_NAMES, GridCell, GridWorld

HORIZON: Final = 16
"""Steps of each world between two updates."""
EPOCHS: Final = 10
"""Times that each batch of steps is learned from."""
GAE_LAMBDA: Final = 0.95
CRITIC_RATE: Final = 0.5
"""The part of the way to its target that a critic's value goes in an epoch."""


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


class PpoLearner(GridLearner):
    """Learns the chances of moves. ``values`` are these chances, so that arrows and numbers show the policy."""

    algorithm: ClassVar[str] = "ppo"

    def __init__(self, world: GridWorld, settings: GridLearnerSettings) -> None:
        self.logits: FloatArray = np.zeros((world.shape[0] * world.shape[1], len(MOVE_NAMES)))
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

    def choose(self, cell: GridCell) -> int:
        """Draws a move by its chance; there is no epsilon."""
        return self._draw(cell)

    def _draw(self, cell: GridCell) -> int:
        return draw(softmax(self.logits[self.world.number_of(cell)]), self._policy_rng)

    def learn(
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
        cells, moves, rewards, reached, terminated, ended = (
            np.array(part) for part in zip(*self._batch, strict=True)
        )
        values = self.critic[cells]
        advantages = self.advantages(rewards, values, self.critic[reached], terminated, ended)
        returns = (advantages + values).ravel()
        weights = ((advantages - advantages.mean()) / (advantages.std() + 1e-8)).ravel()
        cells, moves = cells.ravel(), moves.ravel()
        old = softmax(self.logits[cells])[np.arange(len(cells)), moves]
        for _ in range(EPOCHS):
            self._ascend_objective(cells, moves, weights, old)
            totals, counts = np.zeros(len(self.critic)), np.zeros(len(self.critic))
            np.add.at(totals, cells, returns - self.critic[cells])
            np.add.at(counts, cells, 1.0)
            self.critic += CRITIC_RATE * totals / np.maximum(1.0, counts)

    def _ascend_objective(
        self, cells: IntArray, moves: IntArray, weights: FloatArray, old: FloatArray
    ) -> None:
        """One step up the clipped objective, with the bonus for entropy."""
        settings, rows = self.settings, np.arange(len(cells))
        chances = softmax(self.logits[cells])
        one_hot = np.zeros_like(chances)
        one_hot[rows, moves] = 1.0
        pull = self.objective_slope(chances[rows, moves], np.maximum(old, 1e-12), weights)
        slope = pull[:, None] * (one_hot - chances)
        slope += settings.entropy * self.entropy_slope(cells)
        totals, counts = np.zeros_like(self.logits), np.zeros(len(self.logits))
        np.add.at(totals, cells, slope)
        np.add.at(counts, cells, 1.0)
        self.logits += settings.alpha * totals / np.maximum(1.0, counts)[:, None]

    def advantages(
        self,
        rewards: FloatArray,
        values: FloatArray,
        next_values: FloatArray,
        terminated: BoolArray,
        ended: BoolArray,
    ) -> FloatArray:
        """(steps, worlds): how much better each step went than the critic expected. ``next_values``: of the states reached,
        also where the episode terminated."""
        future = np.where(terminated, 0.0, next_values)
        return advantages_of(rewards, values, future, ended, self.settings.gamma)

    def objective_slope(self, now: FloatArray, then: FloatArray, weights: FloatArray) -> FloatArray:
        """(steps,): how much the clipped objective of each step grows with the logarithm of its chance. ``now`` and ``then``:
        the chance of its move; ``weights``: its advantage."""
        ratio, clip = now / then, self.settings.clip
        if clip > 0:
            # Outside the clip range the objective is flat where it would gain, so there is no slope.
            is_flat = ((weights > 0) & (ratio > 1 + clip)) | ((weights < 0) & (ratio < 1 - clip))
            weights = np.where(is_flat, 0.0, weights)
        return weights * ratio

    def entropy_slope(self, cells: IntArray) -> FloatArray:
        """(steps, moves): how much the entropy in each step's cell grows with each score there."""
        chances = softmax(self.logits[cells])
        logs = np.log(chances + 1e-12)
        entropy = -(chances * logs).sum(axis=1, keepdims=True)
        slope: FloatArray = -chances * (logs + entropy)
        return slope

    def _show_chances(self) -> None:
        self.values = softmax(self.logits).reshape(self.values.shape)
