"""One student in one lesson: what every face lets them do, and what the journal hears of it."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from kit.school.lessons import exercise_files
from kit.school.lessons.checking import Check, CheckReport
from kit.school.lessons.lesson_progress import Standing, standing
from kit.school.lessons.records import Exercise, Lesson, Option, Step
from kit.school.progress import Kind, Progress
from kit.school.result import CriterionResult
from kit.workspace import Workspace

REPLAY = ".worst.npz"
"""Beside the student's file: the worst episode of the newest check."""


@dataclass(frozen=True, slots=True)
class Hint:
    """One step of help with one criterion."""

    criterion: CriterionResult
    number: int
    text: str
    more: int
    """How many steps follow."""


class Visit:
    """Everything but the drawing. Methods that note something raise ProgressError where the disk refuses, and
    WorkError where the student's files cannot be laid out."""

    def __init__(self, lesson: Lesson, progress: Progress, workspace: Workspace) -> None:
        self.lesson = lesson
        self.progress = progress
        self._workspace = workspace
        self._standing = self._fold()
        self._reports: dict[str, CheckReport] = {}

    @property
    def standing(self) -> Standing:
        return self._standing

    @property
    def first_step(self) -> Step:
        """Where to begin or to go on."""
        return self._standing.next_step

    def step(self, number: int) -> Step:
        """A step by its number; the nearest one for a number there is none of."""
        return self.lesson.steps[min(max(number, 1), len(self.lesson.steps)) - 1]

    def go_through(self, step: Step) -> None:
        """The student has done with a step. Those with an exercise are done by passing it."""
        if step.number not in self._standing.gone_through:
            self._note(Kind.STEP, self.lesson.subject(step))

    def foreseen(self, step: Step) -> Option | None:
        """What was foreseen first; None if nothing yet."""
        chosen = self._standing.predictions.get(step.number)
        return step.options[chosen] if chosen is not None and 0 <= chosen < len(step.options) else None

    def foresee(self, step: Step, chosen: int) -> Option:
        """Keeps a prediction, once: later ones change nothing. IndexError if there is no such option."""
        option = step.options[chosen]
        if self.foreseen(step) is None:
            self._note(Kind.PREDICTION, self.lesson.subject(step), {"chosen": chosen, "right": option.right})
        return option

    def file(self, exercise: Exercise) -> Path:
        """What the student edits."""
        return exercise_files.file_of(self._workspace, self.lesson, exercise)

    def lay_out(self, exercise: Exercise) -> Path:
        """Makes what is missing of the student's files."""
        return exercise_files.lay_out(self._workspace, self.lesson, exercise)

    def begin_again(self, exercise: Exercise) -> Path | None:
        """The exercise as at first; where the former files were kept."""
        self._reports.pop(exercise.name, None)
        return exercise_files.begin_again(self._workspace, self.lesson, exercise, now=datetime.now(UTC))

    def check(self, exercise: Exercise) -> Check:
        """Starts a check. Its report is to be handed to ``take``."""
        file = self.file(exercise)
        recording = file.parent / REPLAY if file.parent.is_dir() else None
        return Check(exercise, file, recording=recording)

    def take(self, exercise: Exercise, report: CheckReport) -> None:
        """Notes what came of a check; one that broke counts for nothing."""
        self._reports[exercise.name] = report
        if not report.is_broken and report.criteria:
            self._note(Kind.ATTEMPT, self.lesson.subject_of(exercise), dict(report.as_event()))

    def report(self, exercise: Exercise) -> CheckReport | None:
        """The newest check's, of this visit."""
        return self._reports.get(exercise.name)

    def hints(self, exercise: Exercise) -> tuple[Hint, ...]:
        """The hints opened so far for the first criterion that was lost."""
        lost = self._first_lost(exercise)
        if lost is None:
            return ()
        opened = min(self._standing.hints_open(exercise, lost.id), len(lost.hints))
        return tuple(_hint(lost, number) for number in range(1, opened + 1))

    def next_hint(self, exercise: Exercise) -> Hint | None:
        """Opens one more hint for the first criterion that was lost; None where there is none left, or none was
        lost."""
        lost = self._first_lost(exercise)
        if lost is None:
            return None
        number = self._standing.hints_open(exercise, lost.id) + 1
        if number > len(lost.hints):
            return None
        self._note(Kind.HINT, f"{self.lesson.subject_of(exercise)}/{lost.id}", {"step": number})
        return _hint(lost, number)

    def may_see_solution(self, exercise: Exercise) -> bool:
        """After success, and not before."""
        return exercise.name in self._standing.passed

    def solution(self, exercise: Exercise) -> dict[str, str]:
        """The reference solution's files by name; empty before success, or where none was installed."""
        if not self.may_see_solution(exercise):
            return {}
        files = exercise_files.solution(self.lesson, exercise)
        if files and exercise.name not in self._standing.solutions:
            self._note(Kind.SOLUTION, self.lesson.subject_of(exercise))
        return files

    def _first_lost(self, exercise: Exercise) -> CriterionResult | None:
        report = self._reports.get(exercise.name)
        return next(iter(report.lost_criteria), None) if report is not None else None

    def _note(self, kind: Kind, subject: str, content: dict[str, object] | None = None) -> None:
        self.progress.add(kind, subject, content)
        self._standing = self._fold()

    def _fold(self) -> Standing:
        return standing(self.lesson, self.progress.events())


def _hint(lost: CriterionResult, number: int) -> Hint:
    return Hint(lost, number, lost.hints[number - 1], len(lost.hints) - number)
