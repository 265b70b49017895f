"""Defines the interface between the training loop and a learner, deep or tabular."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol

from kit.arrays import FloatArray
from kit.learning.environment.episode_stats import EpisodeStats
from kit.learning.policies.policy import Policy


class StopLearning(Exception):
    """Ends learning between two updates; not an error."""


class TrainingCallback(Protocol):
    """Callbacks during training."""

    def between_updates(self) -> None:
        """Called very often, between two updates of the policy. May raise StopLearning."""

    def on_episode_end(self, episode: EpisodeStats) -> None:
        """Called for each training episode that has ended."""


class Learner(Protocol):
    """A learner of one task."""

    @property
    def steps(self) -> int:
        """Steps of all worlds so far."""

    def learn(self, steps: int, callback: TrainingCallback) -> None:
        """Learns until there have been ``steps`` in all, or a little longer. Lets StopLearning through."""

    def assign_cases(self, shares: FloatArray) -> None:
        """Assigns a share of the worlds to each case, (cases,), from the next episodes on; no effect where worlds take the
        cases in turn."""

    def policy(self) -> Policy:
        """Returns the present policy."""

    def measures(self) -> dict[str, float]:
        """Returns what it measures of its own learning, by the names of ``kit.learning.training.measures``; it may be nothing."""

    def snapshot(self) -> Any:
        """Returns a copy of what it has learned, for ``restore``."""

    def restore(self, known: Any) -> None:
        """Goes back to a snapshot, and learns more slowly from now on."""

    def save(self) -> dict[str, bytes]:
        """All that it takes to go on in another process; without code, so that it is safe to read."""

    def load(self, parts: Mapping[str, bytes]) -> None:
        """The reverse of ``save``. ValueError if the parts are of another learner."""
