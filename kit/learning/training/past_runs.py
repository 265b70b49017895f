"""How long trainings of a kind took here: the only honest figure for how long the next one will take on this machine."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from statistics import median
from typing import Final

from kit.learning.training.run_config import RunConfig, RunError
from kit.learning.training.run_folders import list_runs
from kit.learning.training.training import resolve_preset

MOST_READ: Final = 50
"""Runs that are looked at, the newest first."""


@dataclass(frozen=True, slots=True)
class ExpectedTime:
    """What is known before a training begins."""

    most_steps: int
    """At these the preset ends it."""
    like_it: tuple[float, ...]
    """How long each training with the same task, algorithm and preset took here that reached its end [s]."""
    rate: float
    """Steps per second of the newest training here of the same algorithm; 0: there is none."""

    @property
    def usual_seconds(self) -> float | None:
        """The median of those that were like it [s]."""
        return median(self.like_it) if self.like_it else None

    @property
    def most_seconds(self) -> float | None:
        """How long all steps take at the known rate [s]."""
        return self.most_steps / self.rate if self.rate else None


def expected_time(folder: Path, config: RunConfig) -> ExpectedTime:
    """Looks through the runs in a folder. Raises what a wrong task raises."""
    most_steps = resolve_preset(config).steps
    like_it, rate = [], 0.0
    for run in list_runs(folder)[:MOST_READ]:
        try:
            other, summary = run.config(), run.summary()
        except RunError:
            continue
        if other.algorithm != config.algorithm:
            continue
        rate = rate or summary.rate
        is_like_it = (other.choice, other.preset, other.settings) == (
            config.choice,
            config.preset,
            config.settings,
        )
        if is_like_it and summary.state == "finished":
            like_it.append(summary.seconds)
    return ExpectedTime(most_steps, tuple(like_it), rate)
