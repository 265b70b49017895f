"""Repair a program against the clock, which runs from the first look at the challenge."""

from __future__ import annotations

import math
import shutil
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final, Self

from kit.school.game.challenge import AnswerError, AnswerSubmission, ChallengeTask
from kit.school.game.judgement import AnswerComparison, Judgement
from kit.school.game.medal import Medal
from kit.school.lessons.checking import ExerciseCheck
from kit.school.lessons.reading import STARTER_FOLDER
from kit.school.lessons.records import Exercise
from kit.world.yaml_section import Section

POLL_S: Final = 0.1
"""Between two looks at the check of a program [s]."""


@dataclass(frozen=True, slots=True)
class RepairTask(ChallengeTask):
    """A program with faults. The answer is the repaired file."""

    kind = "repair"

    folder: Path
    """The grader's assignment; its starter is what has the faults."""
    file: str
    clock: tuple[float, float]

    @classmethod
    def read(cls, section: Section, folder: Path) -> Self:
        return cls(
            folder / section.text("exercise"),
            section.name("file"),
            (section.number("gold_seconds", above=0), section.number("silver_seconds", above=0)),
        )

    def prepare(self, folder: Path, about: Sequence[str]) -> Path | None:
        """Copies the faulty program into ``folder`` unless it is there."""
        if not folder.exists():
            shutil.copytree(self.folder / STARTER_FOLDER, folder)
        return folder / self.file

    def read_answer(self, file: Path) -> str:
        return str(file)  # the file itself is handed in

    def judge(self, submission: AnswerSubmission) -> Judgement:
        file = Path(submission.answer)
        if not file.is_file() or file.name != self.file:
            raise AnswerError(f"Hand in the repaired {self.file}; {file} is not it.")
        exercise = Exercise(self.folder.name, self.folder, self.file, seconds=60.0)
        with ExerciseCheck(exercise, file) as check:
            while (report := check.poll()) is None:
                submission.show_progress(check.progress)
                time.sleep(POLL_S)
        if report.result is None:
            raise AnswerError(report.problem)
        if report.lost_criteria:
            lost = report.lost_criteria[0]
            return Judgement(Medal.NONE, f"Not repaired yet: {lost.rationale or lost.title}")
        seconds, (gold_s, silver_s) = submission.seconds, self.clock
        text = f"Repaired after {seconds:.0f} s; gold is at {gold_s:.0f} s, silver at {silver_s:.0f} s."
        rungs = ((Medal.BRONZE, math.inf), (Medal.SILVER, silver_s), (Medal.GOLD, gold_s))
        others = (("gold at", gold_s), ("silver at", silver_s))
        comparison = AnswerComparison("s", seconds, others, rungs)
        return Judgement(comparison.medal, text, comparison)


KIND = RepairTask
