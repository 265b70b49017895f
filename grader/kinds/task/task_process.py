"""A task in a process of its own, which reads it and measures what checks ask for."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from grader.evidence.reader_process import MEMORY_LIMIT, ReaderProcess
from grader.problem_text import numbered
from kit.host.failure import StudentCodeError
from kit.host.sandbox.sandbox_config import Level
from kit.host.wire import printable

if TYPE_CHECKING:
    from grader.evidence.submission_clock import SubmissionClock
    from grader.evidence.training_results import PosedTaskPlan


LONGEST_S: Final = 24 * 3600.0
"""Seconds for one answer where a submission has no limit."""


@dataclass(frozen=True, slots=True)
class PosedMeasure:
    """The measured value of one check."""

    value: float
    explanation: str = ""
    """For the student; may be empty."""
    picture: str = ""
    """Picture in plain characters; may be empty."""


class PosedTaskProcess(ReaderProcess):
    """One task in a process of its own. What a check measures is worked out when it is first asked for."""

    def __init__(
        self,
        file: Path,
        plan: PosedTaskPlan,
        seed: int,
        level: Level,
        clock: SubmissionClock,
    ) -> None:
        super().__init__(
            "grader.kinds.task.child",
            file,
            subject="task or its world",
            advice="Look at it with the kit (`kit task check`)",
            memory=MEMORY_LIMIT,
            level=level,
        )
        self._clock = clock
        self._found: dict[tuple[str, tuple[str, ...]], PosedMeasure] = {}
        self._send({"plan": asdict(plan), "seed": seed})

    def read_task(self) -> str:
        """Returns what is wrong with the task; empty if nothing is. To be called first, and once."""
        self._clock.show_progress("reading the task and its world")
        return numbered(str(self._answer()["problem"]).splitlines())

    def measure(self, check: str, params: Mapping[str, str]) -> PosedMeasure:
        """Measures what a check asks for, by its name and parameters."""
        key = check, tuple(params.values())
        if key not in self._found:
            self._send({"check": check, "params": dict(params)})
            answer = self._answer()
            pictured = "\n".join(map(printable, str(answer["picture"]).split("\n")))
            value = float(answer["value"])
            self._found[key] = PosedMeasure(value, printable(str(answer["explanation"])), pictured)
        return self._found[key]

    def _answer(self) -> Mapping[str, Any]:
        seconds = LONGEST_S if math.isinf(self._clock.left_s) else self._clock.left_s
        slow = self._clock.used_up_failure()
        try:
            return self._await_answer(seconds, slow, self._clock.show_progress)
        except StudentCodeError:
            self.close()
            raise
