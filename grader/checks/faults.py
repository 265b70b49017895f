"""Shared by the checks of worlds: the records they measure, and checks that count faults."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, Final

from grader.checks.contract import Check, Faults, NoParams, check
from grader.evidence.contract import EvidenceRecord
from grader.evidence.world.facts import RunFacts, WorldFacts
from kit.plain_text import counted, quoted, suggestion

UNSPECIFIED: Final = math.nan
"""Default of a number that is not checked: NaN never exceeds a tolerance."""


@dataclass(frozen=True)
class WorldContents:
    """A world that was read, or could not be."""

    world: WorldFacts

    @property
    def outcome(self) -> str:
        count_faults = len(self.world.problems)
        return f"{count_faults} mistake{'s' if count_faults > 1 else ''}" if count_faults else "read"


@dataclass(frozen=True)
class WorldRun:
    """A world that ran."""

    world: WorldFacts
    run: RunFacts
    has_target: bool

    @property
    def outcome(self) -> str:
        run = self.run
        if run.problem:
            return "not run"
        if not self.has_target:
            return f"ran {run.seconds:.1f} s"
        if run.reached_s is not None:
            return f"reached after {run.reached_s:.1f} s"
        return f"not reached, {counted(run.bumps, 'bump')}" if run.bumps else "not reached"


NO_WORDS: Final = ("", "")
"""Of a check that counts faults: the faults themselves say more than their number."""

WorldFaults = Callable[[WorldFacts, Any], Iterator[str]]
RunFaults = Callable[[WorldRun, Any], Iterator[str]]


def world_check(params: type[Any] = NoParams) -> Callable[[WorldFaults], Check]:
    """Makes a check of a function that yields what is wrong with a world; its docstring is the feedback.

    The check measures how many faults there are; NaN for a world that cannot be read.
    """

    def make(find: WorldFaults) -> Check:
        def count(evidence: EvidenceRecord, given: Any) -> float:
            world: WorldFacts = evidence.content.world
            return math.nan if world.problems else float(sum(1 for _ in find(world, given)))

        return _fault_check(find, count, params, lambda contents, given: find(contents.world, given))

    return make


def run_check(params: type[Any] = NoParams) -> Callable[[RunFaults], Check]:
    """The same for what is wrong with a world's run; the measure is NaN where there was none."""

    def make(find: RunFaults) -> Check:
        def count(evidence: EvidenceRecord, given: Any) -> float:
            run = evidence.content
            if not isinstance(run, WorldRun) or run.run.problem:
                return math.nan
            return float(sum(1 for _ in find(run, given)))

        return _fault_check(find, count, params, find)

    return make


def _fault_check(
    find: Callable[[Any, Any], Iterator[str]],
    count: Callable[[EvidenceRecord, Any], float],
    params: type[Any],
    faults: Faults,
) -> Check:
    count.__name__, count.__doc__ = find.__name__, find.__doc__
    return check(none=1, full=0, words=NO_WORDS, params=params, faults=faults)(count)


def format_metres(value: float) -> str:
    """Formats a length in metres."""
    return f"{round(value, 3) + 0.0:g} m"


def missing_model(world: WorldFacts, name: str) -> str:
    """Returns a message about a missing model, with the nearest name."""
    return f"there is no model {quoted(name)}: {suggestion(name, [model.name for model in world.models])}"
