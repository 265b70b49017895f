"""One student working on one lesson: the actions of all faces, recorded in the journal."""

from __future__ import annotations

import contextlib
import shutil
import zlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from kit.host.sandbox.probe import highest_level_up_to
from kit.host.sandbox.sandbox_config import INTERACTIVE_LEVEL, Level
from kit.results.grading_result import CriterionResult
from kit.school.game.levels import GameLevel, levels_of_lesson
from kit.school.lessons import checking
from kit.school.lessons.catalogue import LessonProgress, lesson_progress_from_events
from kit.school.lessons.checking import CheckReport, ExerciseCheck
from kit.school.lessons.defence import Defence, prepare_defence
from kit.school.lessons.reading import LESSON_FILE, lesson_names, read_lesson
from kit.school.lessons.records import Exercise, Lesson, LessonStep, PredictionOption
from kit.school.progress import EventKind, ProgressJournal
from kit.workspace import Workspace
from kit.world.problems import WorldError

REPLAY_FILE = ".worst.npz"
"""Beside the student's file: the worst episode of the newest check."""
FIRST_DEFENCE_SEED = 1000
"""No exercise is checked with a seed as large as this one."""
PASSED_RUN_FILE = ".passed.npz"
"""Beside the student's file: a run of the newest work that passed."""


@dataclass(frozen=True, slots=True)
class LessonHint:
    """One hint for one criterion."""

    criterion: CriterionResult
    number: int
    text: str


class LessonSession:
    """A student's work on a lesson, without any user interface. Methods that record something raise ProgressError if
    it cannot be written; those that make files raise ExerciseFilesError."""

    def __init__(
        self, lesson: Lesson, journal: ProgressJournal, workspace: Workspace, *, as_class: bool = False
    ) -> None:
        """``as_class``: exercises are checked at the confinement level at which a class is graded."""
        self.lesson = lesson
        self._as_class = as_class or lesson.is_foreign
        self.journal = journal
        self.workspace = workspace
        self._lesson_progress = self._read_progress()
        self._reports: dict[str, CheckReport] = {}

    @property
    def own_code_level(self) -> Level:
        """The confinement of the student's lines where they are not graded: as in a drive, or as this machine can where
        somebody else's lesson asks for them. Slow the first time."""
        return highest_level_up_to(max(Level)) if self.lesson.is_foreign else INTERACTIVE_LEVEL

    @property
    def lesson_progress(self) -> LessonProgress:
        return self._lesson_progress

    @property
    def first_step(self) -> LessonStep:
        """The step to begin or to continue with."""
        return self._lesson_progress.next_step

    def find_next(self) -> LessonSession | None:
        """The same student's work on the next lesson of the folder; None after the last one, or if it cannot be read."""
        if self.lesson.is_foreign:
            return self._find_next_in_folder()
        names = lesson_names(self.lesson.folder.parent)
        after = names[names.index(self.lesson.name) + 1 :]
        if not after:
            return None
        try:
            lesson = read_lesson(self.lesson.folder.parent / after[0])
        except WorldError:
            return None
        return LessonSession(lesson, self.journal, self.workspace, as_class=self._as_class)

    def _find_next_in_folder(self) -> LessonSession | None:
        """Returns the next lesson of a folder that is not the kit's own; None after the last."""
        folder = self.lesson.folder
        after = sorted(
            each.parent for each in folder.parent.glob(f"[!.]*/{LESSON_FILE}") if each.parent > folder
        )
        try:
            lesson = read_lesson(after[0], is_foreign=True) if after else None
        except WorldError:
            return None
        return None if lesson is None else LessonSession(lesson, self.journal, self.workspace)

    def opened_levels(self) -> tuple[GameLevel, ...]:
        """The levels of the game that this lesson opens; none where they cannot be read."""
        try:
            return levels_of_lesson(self.lesson.name)
        except (WorldError, FileNotFoundError):
            return ()

    def find_step(self, number: int) -> LessonStep:
        """The step with a number; the nearest one for a number out of range."""
        return self.lesson.steps[min(max(number, 1), len(self.lesson.steps)) - 1]

    def complete_step(self, step: LessonStep) -> None:
        """Marks a step as completed. Steps with an exercise are completed by passing it instead."""
        if step.number not in self._lesson_progress.completed_steps:
            self._record_event(EventKind.STEP, self.lesson.step_subject(step))

    def prediction(self, step: LessonStep) -> PredictionOption | None:
        """The first prediction made for a step; None if there is none yet."""
        chosen = self._lesson_progress.predictions.get(step.number)
        return step.options[chosen] if chosen is not None and 0 <= chosen < len(step.options) else None

    def predict(self, step: LessonStep, chosen: int) -> PredictionOption:
        """Records a prediction, once: later ones change nothing. Raises IndexError if there is no such option."""
        option = step.options[chosen]
        if self.prediction(step) is None:
            self._record_event(
                EventKind.PREDICTION,
                self.lesson.step_subject(step),
                {"chosen": chosen, "right": option.is_right},
            )
        return option

    def exercise_file(self, exercise: Exercise) -> Path:
        """The file that the student edits."""
        return checking.exercise_file(self.workspace, self.lesson, exercise)

    def install(self, exercise: Exercise) -> Path:
        """Creates the missing files of the exercise; returns the file to edit."""
        return checking.install_exercise(self.workspace, self.lesson, exercise)

    def reset(self, exercise: Exercise) -> Path | None:
        """Resets the exercise to its starter files; returns the backup folder, if any."""
        self._reports.pop(exercise.name, None)
        return checking.reset_exercise(self.workspace, self.lesson, exercise, now=datetime.now(UTC))

    def start_check(self, exercise: Exercise) -> ExerciseCheck:
        """Starts a check. Pass its report to ``record``."""
        file = self.exercise_file(exercise)
        recording = file.parent / REPLAY_FILE if file.parent.is_dir() else None
        return ExerciseCheck(exercise, file, recording=recording, as_class=self._as_class)

    def record(self, exercise: Exercise, report: CheckReport) -> None:
        """Records the report of a check; one that broke does not count as an attempt."""
        self._reports[exercise.name] = report
        if report.is_passed and report.recording is not None:
            with contextlib.suppress(OSError):  # a run to look at again is no reason to lose the pass
                shutil.copyfile(report.recording, self._passed_run_file(exercise))
        if not report.is_broken and report.criteria:
            self._record_event(
                EventKind.ATTEMPT, self.lesson.exercise_subject(exercise), dict(report.as_event())
            )

    def latest_report(self, exercise: Exercise) -> CheckReport | None:
        """The report of the newest check of this session; None if there is none."""
        return self._reports.get(exercise.name)

    def recorded_run(self, exercise: Exercise) -> Path | None:
        """The recording of the newest check, before there is one that of an earlier pass; None: there is none."""
        report = self._reports.get(exercise.name)
        if report is not None:
            return report.recording
        kept = self._passed_run_file(exercise)
        return kept if kept.is_file() else None

    def has_driven(self, exercise: Exercise) -> bool:
        """Whether the student has handed in a drive of their own; True for work that is no drive."""
        return not exercise.is_driven or not checking.is_untouched(self.exercise_file(exercise), exercise)

    def can_defend(self, exercise: Exercise) -> bool:
        """Whether there are questions to ask about the student's program: it has passed, and its run was recorded."""
        return (
            exercise.is_program
            and exercise.name in self._lesson_progress.passed_exercises
            and self._passed_run_file(exercise).is_file()
        )

    def prepare_defence(self, exercise: Exercise) -> Defence:
        """Runs the student's program from a start that was not seen before. Slow. Raises DefenceError."""
        count = self._lesson_progress.defences.get(exercise.name, 0)
        seed = (
            FIRST_DEFENCE_SEED
            + zlib.crc32(f"{self.lesson.exercise_subject(exercise)} {count}".encode()) % 10**6
        )
        return prepare_defence(self.exercise_file(exercise), self._passed_run_file(exercise), seed)

    def record_defence(self, exercise: Exercise, defence: Defence, answers: Sequence[int]) -> int:
        """Records the answers, one for each question; returns how many are right."""
        right = defence.right_count(answers)
        content: dict[str, object] = {"asked": len(defence.questions), "right": right}
        self._record_event(EventKind.DEFENCE, self.lesson.exercise_subject(exercise), content)
        return right

    def opened_hints(self, exercise: Exercise) -> tuple[LessonHint, ...]:
        """The hints opened so far for the criteria that did not pass, in the order in which they are opened."""
        return tuple(
            LessonHint(lost, number, lost.hints[number - 1])
            for lost in self._lost_criteria(exercise)
            for number in range(1, self._opened_count(exercise, lost) + 1)
        )

    def next_hint(self, exercise: Exercise) -> LessonHint | None:
        """Opens one more hint. Each criterion that knows the mistake says it first; then come their other hints, then
        those of the others that did not pass, in their order. None where all are open, or there is none."""
        lost = next(self._with_closed_hints(exercise), None)
        if lost is None:
            return None
        number = self._opened_count(exercise, lost) + 1
        self._record_event(
            EventKind.HINT, f"{self.lesson.exercise_subject(exercise)}/{lost.id}", {"step": number}
        )
        return LessonHint(lost, number, lost.hints[number - 1])

    def has_closed_hints(self, exercise: Exercise) -> bool:
        """Whether ``next_hint`` opens one."""
        return next(self._with_closed_hints(exercise), None) is not None

    def can_see_solution(self, exercise: Exercise) -> bool:
        """Whether the exercise has been passed."""
        return exercise.name in self._lesson_progress.passed_exercises

    def open_solution(self, exercise: Exercise) -> dict[str, str]:
        """The reference solution's files by name; empty before the exercise is passed, or where none was installed."""
        if not self.can_see_solution(exercise):
            return {}
        files = checking.read_solution(self.lesson, exercise)
        if files and exercise.name not in self._lesson_progress.opened_solutions:
            self._record_event(EventKind.SOLUTION, self.lesson.exercise_subject(exercise))
        return files

    def _passed_run_file(self, exercise: Exercise) -> Path:
        return self.exercise_file(exercise).with_name(PASSED_RUN_FILE)

    def _lost_criteria(self, exercise: Exercise) -> Sequence[CriterionResult]:
        report = self._reports.get(exercise.name)
        lost = () if report is None else report.lost_criteria
        return sorted(lost, key=lambda each: not each.knows_mistake)  # sorting keeps the order of equals

    def _opened_count(self, exercise: Exercise, lost: CriterionResult) -> int:
        return min(self._lesson_progress.opened_hint_count(exercise, lost.id), len(lost.hints))

    def _with_closed_hints(self, exercise: Exercise) -> Iterator[CriterionResult]:
        closed = [
            lost
            for lost in self._lost_criteria(exercise)
            if self._opened_count(exercise, lost) < len(lost.hints)
        ]
        yield from sorted(
            closed, key=lambda lost: not lost.knows_mistake or self._opened_count(exercise, lost) > 0
        )

    def _record_event(self, kind: EventKind, subject: str, content: dict[str, object] | None = None) -> None:
        self.journal.add(kind, subject, content)
        self._lesson_progress = self._read_progress()

    def _read_progress(self) -> LessonProgress:
        return lesson_progress_from_events(self.lesson, self.journal.events())
