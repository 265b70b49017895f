"""What training asks of every learner, deep or tabular, and what a learner tells in return."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from kit.learning.environment.episode_stats import EpisodeStats
from kit.learning.policies.policies import Policy


class StopLearning(Exception):
    """Ends learning between two updates; not an error."""


class TrainingCallback(Protocol):
    """Who looks on while a learner learns."""

    def between_updates(self) -> None:
        """Called where the policy stands still, very often. May raise Halt."""

    def on_episode_end(self, episode: EpisodeStats) -> None:
        """An episode of training has ended."""


class Learner(Protocol):
    """One who learns a task."""

    @property
    def steps(self) -> int:
        """Steps of all worlds so far."""

    def learn(self, steps: int, callback: TrainingCallback) -> None:
        """Learns until there have been ``steps`` in all, or a little longer. Lets Halt through."""

    def assign_cases(self, shares: NDArray[np.float64]) -> None:
        """Practises so large a part on each case, (cases,), from the next episodes on; as before where worlds take the
        cases in turn."""

    def policy(self) -> Policy:
        """What it would do now."""

    def snapshot(self) -> Any:
        """What it knows now, for ``restore``."""

    def restore(self, known: Any) -> None:
        """Knows again what it knew then, and learns more slowly from now on."""

    def save(self) -> dict[str, bytes]:
        """All that it takes to go on in another process; without code, so that it is safe to read."""

    def load(self, parts: Mapping[str, bytes]) -> None:
        """The reverse of ``save``. ValueError if the parts are of another learner."""
