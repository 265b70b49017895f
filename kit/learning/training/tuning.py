"""Looks for better settings: optuna proposes some, a sweep trains them from several seeds, and optuna is told the cost.

optuna's sampler starts from a fixed seed and is told the costs in a fixed order, so the same command proposes the same
settings again: a search that was interrupted goes on with the results in its sweep's folder, and needs no other memory.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Final

from kit.installation import install_command
from kit.learning.training.run_check import check_settings
from kit.learning.training.run_config import RunConfig, RunError, format_settings
from kit.learning.training.sweep_table import sweep_rows
from kit.learning.training.training import resolve_preset
from kit.learning.training.training_sweep import TrainingSweep

TRIALS_AT_ONCE: Final = 4
"""Trials that are proposed before the costs of the last ones are known, so that they can be trained side by side."""
LOGARITHMIC_FROM: Final = 10.0
"""A range whose upper end is this many times the lower one is searched by orders of magnitude."""

Settings = tuple[tuple[str, float], ...]


@dataclass(frozen=True, slots=True)
class SettingRange:
    """A setting, and the numbers among which to search."""

    name: str
    low: float
    high: float

    @property
    def is_logarithmic(self) -> bool:
        """Whether it is searched by orders of magnitude."""
        return self.low > 0 and self.high >= LOGARITHMIC_FROM * self.low


def require_optuna() -> None:
    """Raises RunError where the extra ``tune`` is not installed."""
    if find_spec("optuna") is None:
        raise RunError(f"Tuning needs optuna. To have it, type: {install_command('tune')}")


def check_ranges(config: RunConfig, ranges: Sequence[SettingRange]) -> None:
    """Raises RunError for a setting that the algorithm does not have, and for an end of a range that it cannot take."""
    for number in ("low", "high"):
        check_settings(replace(config, settings=tuple((each.name, getattr(each, number)) for each in ranges)))


def tune(
    folder: Path,
    config: RunConfig,
    ranges: Sequence[SettingRange],
    seeds: Sequence[int],
    *,
    trials: int,
    episodes: int,
    goal: float | None = None,
    run: Callable[[TrainingSweep], object],
) -> TrainingSweep:
    """Searches ``ranges`` with this many trials, each trained from all ``seeds``; returns the sweep of all of them.

    ``goal``: as for ``sweep_rows``. ``run`` trains what a sweep waits for; the search ends early where it leaves something
    untried. Raises RunError and OSError.
    """
    import optuna

    optuna.logging.set_verbosity(optuna.logging.WARNING)
    sampler = optuna.samplers.TPESampler(seed=0, constant_liar=True)
    study = optuna.create_study(direction="minimize", sampler=sampler)
    distributions = _distributions(config, ranges)
    configs: dict[Settings, list[RunConfig]] = {}
    while True:
        asked = [study.ask(distributions) for _ in range(min(TRIALS_AT_ONCE, trials - len(study.trials)))]
        proposed = [(*config.settings, *_round_fractions(trial.params, ranges)) for trial in asked]
        for settings in proposed:  # what is proposed twice is trained once
            configs[settings] = [replace(config, settings=settings, seed=seed) for seed in seeds]
        sweep = TrainingSweep.prepare(
            folder, [each for group in configs.values() for each in group], episodes, grows=True
        )
        run(sweep)
        if any(sweep.result(key) is None for key in sweep.waiting()):
            return sweep
        costs = {row.group[-1]: row.cost for row in sweep_rows(sweep, goal)}
        for trial, settings in zip(asked, proposed, strict=True):
            cost = costs[format_settings(settings)]
            failed = math.isinf(cost)
            study.tell(trial, None if failed else cost, optuna.trial.TrialState.FAIL if failed else None)
        if len(study.trials) >= trials:
            return sweep


def _distributions(config: RunConfig, ranges: Sequence[SettingRange]) -> dict[str, Any]:
    from optuna.distributions import FloatDistribution, IntDistribution

    kinds = resolve_preset(config).setting_types()
    return {
        each.name: IntDistribution(int(each.low), int(each.high), log=each.is_logarithmic)
        if kinds[each.name] is int
        else FloatDistribution(each.low, each.high, log=each.is_logarithmic)
        for each in ranges
    }


def _round_fractions(proposed: Mapping[str, float], ranges: Sequence[SettingRange]) -> Settings:
    """Fractions to three digits, which is as exact as anything is found in a few trials, and can be read."""
    return tuple(
        (
            each.name,
            number if isinstance(number, int) else min(max(float(f"{number:.3g}"), each.low), each.high),
        )
        for each in ranges
        for number in (proposed[each.name],)
    )
