"""What learners measure of their own learning: the values that they expect, and how far an update of the policy went.

A value is the discounted sum of rewards that an action is expected to earn. It cannot be more than what rewards can pay:
values that are have been learned from each other, not from rewards.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from kit.arrays import BoolArray, Float32Array, FloatArray

VALUE_MAX, VALUE_MEAN, VALUE_PAYABLE = "value_max", "value_mean", "value_payable"
RECENT: Final = 1000
"""The least number of the last observations that are rated; fewer where there have not been as many."""


@dataclass(frozen=True, slots=True)
class LearnerMeasure:
    """Something that a learner measures of its own learning."""

    name: str
    """The key in events."""
    title: str
    """On screens and in tables."""
    summary: str


MEASURES: Final[Mapping[str, LearnerMeasure]] = {
    each.name: each
    for each in (
        LearnerMeasure(VALUE_MAX, "largest value", "The largest value of the last 1,000 observations."),
        LearnerMeasure(VALUE_MEAN, "mean value", "The mean value of the last 1,000 observations."),
        LearnerMeasure(
            VALUE_PAYABLE,
            "most that rewards pay",
            "The discounted sum of rewards if every step paid as much as the best one so far.",
        ),
        LearnerMeasure(
            "explained_variance",
            "explained variance",
            "How much of the differences between returns the critic predicts: 1 all, 0 nothing.",
        ),
        LearnerMeasure(
            "entropy", "entropy", "How undecided the policy is [nats]; 0: always the same action."
        ),
        LearnerMeasure(
            "clip_fraction",
            "clipped share",
            "The share of steps for which PPO's clipping stopped the update.",
        ),
        LearnerMeasure("approx_kl", "KL", "How far an update took the policy from the last one [nats]."),
    )
}
"""By name, in the order in which they are shown."""


def is_value_too_large(measures: Mapping[str, float]) -> bool:
    """Whether the largest value exceeds what rewards can pay."""
    return measures.get(VALUE_MAX, -math.inf) > measures.get(VALUE_PAYABLE, math.inf)


def value_warning(measures: Mapping[str, float]) -> str:
    """What it means that values exceed what rewards can pay."""
    return (
        f"The largest value, {measures[VALUE_MAX]:,.0f}, exceeds what this task's rewards can pay, "
        f"{measures[VALUE_PAYABLE]:,.0f}: the values are learned from each other and no longer from rewards. What looks best "
        "is chance from here on, and tests go up and down with it. Lower the learning rate or tau, scale the rewards down, or take "
        "a limit away with `--set value_limit=none`."
    )


def format_measures(measures: Mapping[str, float]) -> str:
    """``largest value 12.3, mean value 4.56``; of each the most significant digits."""
    told = ((MEASURES[name].title, number) for name, number in measures.items() if name in MEASURES)
    return ", ".join(f"{title} {format_measure(number)}" for title, number in told)


def format_measure(number: float) -> str:
    """
    >>> [format_measure(number) for number in (57_123_456.0, 747.2, 0.0123)]
    ['57,123,456', '747', '0.0123']
    """
    return f"{number:,.0f}" if abs(number) >= 100.0 else f"{number:.3g}"


class RecentExperience:
    """The last observations of all worlds, and the largest rewards so far."""

    def __init__(self, worlds: int, size: int) -> None:
        """``size``: numbers of an observation."""
        self._seen = np.zeros((-(-RECENT // worlds), worlds, size), dtype=np.float32)
        self._count = 0
        self._largest = np.full(2, -np.inf)
        """Of a step after which the episode goes on; of one that ends it."""

    def add(self, observations: Float32Array, rewards: Float32Array | FloatArray, ended: BoolArray) -> None:
        """Takes what is seen after a step (worlds, size), its rewards (worlds,) and whether it ended an episode (worlds,)."""
        self._seen[self._count % len(self._seen)] = observations
        self._count += 1
        for place, some in enumerate((rewards[~ended], rewards[ended])):
            if len(some):
                self._largest[place] = max(self._largest[place], float(some.max()))

    @property
    def observations(self) -> Float32Array:
        """(n, size)"""
        found: Float32Array = self._seen[: self._count].reshape(-1, self._seen.shape[-1])
        return found

    def largest_return(self, gamma: float, steps: int | None) -> float:
        """The discounted sum of rewards if each of ``steps`` steps, or of endlessly many, paid the most that one has paid so far,
        and the last one the most that a last one has. Infinite before the first step."""
        going, last = (0.0 if math.isinf(each) else max(0.0, float(each)) for each in self._largest)
        if not self._count or (gamma >= 1.0 and steps is None):
            return math.inf
        if gamma >= 1.0:
            assert steps is not None
            return going * steps + last
        return going * (1.0 - (0.0 if steps is None else gamma**steps)) / (1.0 - gamma) + last

    def measures(
        self, values: Float32Array | FloatArray, gamma: float, steps: int | None
    ) -> dict[str, float]:
        """The measures of ``values`` (n,), those of ``observations``; none where there are none, or one is not finite."""
        if not len(values):
            return {}
        found = {
            VALUE_MAX: float(values.max()),
            VALUE_MEAN: float(values.mean()),
            VALUE_PAYABLE: self.largest_return(gamma, steps),
        }
        return {name: number for name, number in found.items() if math.isfinite(number)}

    def save(self) -> list[float]:
        """The largest rewards, for ``load``."""
        return [float(each) for each in self._largest]

    def load(self, largest: list[float]) -> None:
        """ValueError for anything else."""
        self._largest = np.array(largest, dtype=np.float64).reshape(2)
