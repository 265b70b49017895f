"""How the seeds of a table that were trained again have done, beside what was printed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from kit.study.printed_tables import (
    PrintedTable,
)
from kit.study.recorded_results import RecordedResult, RecordedTest, TrainingSession

ACCURACY_GOAL: Final = 0.8
"""To this share of successes in a test the dissertation trains."""


@dataclass(frozen=True, slots=True)
class TrainedSeeds:
    """What trainings of one kind from several seeds came to."""

    tests: tuple[RecordedTest, ...]
    planned: int
    """How many there are to be; at least as many as there are."""

    @classmethod
    def of(cls, table: PrintedTable, result: RecordedResult | None, group: str) -> TrainedSeeds:
        """``result``: None where nothing has been recorded yet."""
        tests = () if result is None else result.tests_of(group)
        return cls(tests, max(len(tests), table.seeds))

    @property
    def reached(self) -> int:
        """How many had a test of ``ACCURACY_GOAL`` or more."""
        return sum(session.share >= ACCURACY_GOAL for session in self.best_sessions)

    @property
    def best_sessions(self) -> tuple[TrainingSession, ...]:
        """The best test of each seed."""
        return tuple(each.best_session for each in self.tests if each.best_session is not None)

    @property
    def steps_to_goal(self) -> tuple[int, ...]:
        """The steps after which each seed that reached the goal did so, in rising order."""
        first = (
            next((each.steps for each in test.sessions if each.share >= ACCURACY_GOAL), None)
            for test in self.tests
        )
        return tuple(sorted(steps for steps in first if steps is not None))

    @property
    def largest_value(self) -> float | None:
        """The largest value of all seeds."""
        return max(
            (each.largest_value for each in self.tests if each.largest_value is not None), default=None
        )
