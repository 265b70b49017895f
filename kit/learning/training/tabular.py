"""Q-learning and SARSA: a number for every state and action, learned from experience, without a network.

Both nudge the value of what was just done towards the reward it gave plus the discounted value of what comes next
(Sutton and Barto, Reinforcement Learning, 2nd edition, sections 6.4 and 6.5). They differ in one word. Q-learning takes
the *best* next action's value, whatever is done next: it learns about the greedy policy while it explores. SARSA takes
the value of the next action *really taken*, exploration included: near a wall it learns to keep a little away.
"""

from __future__ import annotations

import io
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from kit.arrays import FloatArray, IntArray
from kit.learning.environment.batch import BatchEnv
from kit.learning.environment.batch_state import BatchStep
from kit.learning.environment.episode_stats import EpisodeStatsRecorder
from kit.learning.policies.policy import ActionSampling, Policy, action_counts, task_interface
from kit.learning.policies.policy_network import ActionValueTable
from kit.learning.tasks.task_spec import TaskSpec
from kit.learning.training.algorithm_settings import TabularParams
from kit.learning.training.algorithms import Algorithm
from kit.learning.training.checkpoint_file import LearnerCounts, check_rows
from kit.learning.training.learner import TrainingCallback
from kit.learning.training.measures import RecentExperience
from kit.learning.training.presets import Preset

MAX_STATES = 20_000
LEARNING_RATE_FACTOR = 0.5
FEW_WORLDS = 64
"""The most worlds whose states are compared with each other; of more a table of all states is faster."""


class TableLearner(ABC):
    """Learns with ``n`` worlds at once; with one world, line by line what the books say."""

    def __init__(
        self, algorithm: Algorithm, preset: Preset, choice: TaskSpec, batch: BatchEnv, seed: int
    ) -> None:
        assert isinstance(preset.settings, TabularParams)
        self._algorithm = algorithm
        self._settings = preset.settings
        self._choice = choice
        self._batch = batch
        self._rng = np.random.default_rng(seed)
        self._table = _empty_table(batch, self._settings)
        self._values: FloatArray = np.zeros(self._table.values.shape)
        self._steps = 0
        self._rate_factor = 1.0
        self._recent = RecentExperience(batch.n, int(batch.observation_space.shape[0]))

    def assign_cases(self, shares: FloatArray) -> None:
        if self._batch.has_fixed_cases:
            self._batch.assign_cases(shares)

    # The lesson

    def learn(self, steps: int, callback: TrainingCallback) -> None:
        """Drives all worlds and learns from every step."""
        state, recorder = self._table.states(self._batch.reset()), EpisodeStatsRecorder(self._batch)
        action = self._choose_actions(state, steps)
        while self._steps < steps:
            callback.between_updates()
            step = self._batch.step(action)
            reached_state = self._table.states(step.final_observations())
            next_action = self._choose_actions(reached_state, steps)
            self._update(state, action, step, reached_state, next_action, 1 - self._steps / steps)
            self._steps += self._batch.n
            self._recent.add(step.observations, step.rewards, step.ended)
            for episode in recorder.add(step):
                callback.on_episode_end(episode)
            # Where no episode ends, the next one's first observation is none of them.
            state = self._table.states(step.observations) if step.ended.any() else reached_state
            action = np.where(step.ended, self._choose_actions(state, steps), next_action)

    def _update(
        self,
        state: IntArray,
        action: IntArray,
        step: BatchStep,
        reached: IntArray,
        following: IntArray,
        left: float,
    ) -> None:
        """Moves each value a little towards what experience says. An end has no future; a timeout has."""
        future = np.where(step.terminated, 0.0, self.next_value(reached, following))
        target = step.rewards + self._settings.gamma * future
        error = target - self._values[state, action]
        pair = state * self._values.shape[1] + action
        # Worlds that did the same in the same state move its value by their mean.
        alike = (
            np.count_nonzero(pair[:, None] == pair, axis=1)
            if len(pair) <= FEW_WORLDS
            else np.bincount(pair)[pair]
        )
        np.add.at(
            self._values,
            (state, action),
            self._rate_factor * self._settings.rate.value_at(left) * error / alike,
        )

    @abstractmethod
    def next_value(self, state: IntArray, action: IntArray) -> FloatArray:
        """The value of the next state, where ``action`` will be taken in it."""

    def _choose_actions(self, state: IntArray, steps: int) -> IntArray:
        """The best action, or now and then any."""
        epsilon = self._settings.epsilon.value_at(max(0.0, 1 - self._steps / steps))
        anything = self._rng.integers(self._values.shape[1], size=len(state))
        best = self._values[state].argmax(axis=1)
        chosen: IntArray = np.where(self._rng.random(len(state)) < epsilon, anything, best)
        return chosen

    # What every learner can do

    @property
    def steps(self) -> int:
        return self._steps

    def policy(self) -> Policy:
        table = replace(self._table, values=self._values.astype(np.float32))
        return Policy(
            table,
            action_counts(self._batch.action_space),
            ActionSampling("epsilon", 0.05),
            self._choice,
            self._steps,
            task_interface(self._batch.task),
        )

    def measures(self) -> dict[str, float]:
        values = self._values[self._table.states(self._recent.observations)].max(axis=1)
        return self._recent.measures(values, self._settings.gamma, None)

    def snapshot(self) -> Any:
        return self._values.copy()

    def restore(self, known: Any) -> None:
        self._values = known.copy()
        self._rate_factor *= LEARNING_RATE_FACTOR

    def save(self) -> dict[str, bytes]:
        values = io.BytesIO()
        np.save(values, self._values)
        counts = LearnerCounts(
            self._algorithm.name, self._steps, self._rate_factor, largest=self._recent.save()
        )
        return {**counts.pack(), "values.npy": values.getvalue()}

    def load(self, parts: Mapping[str, bytes]) -> None:
        counts = LearnerCounts.unpack(parts, self._algorithm.name)
        values = np.load(io.BytesIO(parts["values.npy"]), allow_pickle=False)
        if len(values) != len(self._values) or not (np.abs(values) <= np.finfo(np.float32).max).all():
            raise ValueError("values of another table, or beyond those that a policy keeps")
        self._values = check_rows(values, self._values)
        self._steps, self._rate_factor = counts.steps, counts.slower
        self._recent.load(counts.largest)


class QLearning(TableLearner):
    """Watkins 1989."""

    def next_value(self, state: IntArray, action: IntArray) -> FloatArray:
        best: FloatArray = self._values[state].max(axis=1)
        return best


class Sarsa(TableLearner):
    """Rummery and Niranjan 1994: state, action, reward, state, action."""

    def next_value(self, state: IntArray, action: IntArray) -> FloatArray:
        taken: FloatArray = self._values[state, action]
        return taken


def table_rows(inputs: int, bins: int) -> int:
    """Returns how many rows a table has for this many observed numbers, each sorted into this many bins.

    >>> table_rows(9, 3)
    19683
    """
    return int(bins ** _used_count(inputs, bins))


def _used_count(inputs: int, bins: int) -> int:
    return min(inputs, int(np.log(MAX_STATES) / np.log(bins)))


def _empty_table(batch: BatchEnv, settings: TabularParams) -> ActionValueTable:
    """One that counts as many inputs, evenly spread over what is seen, as make a table of reasonable size."""
    inputs = int(batch.observation_space.shape[0])
    bins = len(settings.edges) + 1
    count = _used_count(inputs, bins)
    used = np.linspace(0, inputs - 1, count).round().astype(np.int64)
    actions = action_counts(batch.action_space)[0]
    values = np.zeros((bins**count, actions), dtype=np.float32)
    return ActionValueTable(used, np.array(settings.edges, dtype=np.float32), values, inputs)
