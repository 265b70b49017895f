"""Shared by the checks of worlds: the records they measure, and checks that count faults."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, Final

from grader.check import Check, Faults, NoParams, check
from grader.evidence.contract import EvidenceRecord
from grader.kinds.world.facts import ModelFacts, RunFacts, WorldFacts
from kit.plain_text import counted, quoted, suggestion

UNSPECIFIED: Final = math.nan
"""Default of a number that is not checked: NaN never exceeds a tolerance."""


@dataclass(frozen=True)
class WorldContents:
    """A world that was read, or could not be."""

    world: WorldFacts

    @property
    def outcome(self) -> str:
        return counted(len(self.world.problems), "mistake") if self.world.problems else "read"


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
"""Words of a check that counts faults: the faults themselves say more than their number."""

WorldFaults = Callable[[WorldFacts, Any], Iterator[str]]
RunFaults = Callable[[WorldRun, Any], Iterator[str]]


class NotInWorld(Exception):
    """A check's subject is not in the world: the message is the check's fault."""


def world_check(params: type[Any] = NoParams) -> Callable[[WorldFaults], Check]:
    """Makes a check of a function that yields what is wrong with a world; its docstring is the feedback.

    The check measures how many faults there are, of which ``NotInWorld`` is the last; NaN for a world that cannot be read.
    """

    def make(find: WorldFaults) -> Check:
        def faults(contents: WorldContents, given: Any) -> Iterator[str]:
            try:
                yield from find(contents.world, given)
            except NotInWorld as missing:
                yield str(missing)

        def count(evidence: EvidenceRecord, given: Any) -> float:
            return (
                math.nan
                if evidence.content.world.problems
                else float(len([*faults(evidence.content, given)]))
            )

        return _fault_check(find, count, params, faults)

    return make


def run_check(params: type[Any] = NoParams) -> Callable[[RunFaults], Check]:
    """As ``world_check``, for a world's run; the measure is NaN where there was none."""

    def make(find: RunFaults) -> Check:
        def count(evidence: EvidenceRecord, given: Any) -> float:
            return measure_run(evidence, lambda _: len([*find(evidence.content, given)]))

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


def measure_run(evidence: EvidenceRecord, measure: Callable[[RunFacts], float]) -> float:
    """Measures a world's run; NaN where there was none."""
    content = evidence.content
    return (
        float(measure(content.run)) if isinstance(content, WorldRun) and not content.run.problem else math.nan
    )


def find_model(world: WorldFacts, name: str) -> ModelFacts:
    """Returns the model of that name. Raises NotInWorld with the nearest name."""
    if (model := world.model(name)) is None:
        nearest = suggestion(name, [model.name for model in world.models])
        raise NotInWorld(f"there is no model {quoted(name)}: {nearest}")
    return model
