"""All lessons with the student's progress, computed from the journal and never stored, and the lesson to continue with."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final

from kit.school.lessons.reading import lesson_names, lesson_number, lessons_folder, read_lesson, read_units
from kit.school.lessons.records import Exercise, Lesson, LessonStep, LessonUnit
from kit.school.progress import EventKind, ProgressEvent
from kit.world.problems import WorldError

MAX_STEP_DIGITS: Final = 4
"""Digits of a step's number."""


@dataclass(frozen=True, slots=True)
class LessonProgress:
    """A student's progress in one lesson."""

    lesson: Lesson
    completed_steps: frozenset[int]
    """Numbers of the steps without exercise that were completed."""
    predictions: dict[int, int]
    """Step number -> index of the first predicted option; later predictions do not count."""
    best_shares: dict[str, float]
    """Exercise -> best share of its points so far, 0 to 1."""
    attempt_counts: dict[str, int]
    passed_exercises: frozenset[str]
    """Exercises that earned all points at least once."""
    opened_hints: dict[str, int]
    """``exercise/criterion`` -> number of opened hints."""
    opened_solutions: frozenset[str]
    """Exercises whose reference solution was opened."""
    defences: dict[str, int]
    """Exercise -> how often it was defended; the number makes each start a new one."""
    defended_exercises: frozenset[str]
    """Exercises of which every question about the student's own program was answered rightly at once."""
    last_activity: str
    """Time of the last event in this lesson, ISO 8601; empty: none."""

    @property
    def has_started(self) -> bool:
        return bool(self.last_activity)

    @property
    def is_completed(self) -> bool:
        """Whether every step is completed and every exercise passed."""
        return all(self.is_step_completed(step) for step in self.lesson.steps)

    @property
    def completed_count(self) -> int:
        """Number of completed steps."""
        return sum(self.is_step_completed(step) for step in self.lesson.steps)

    def is_step_completed(self, step: LessonStep) -> bool:
        if step.exercise is not None:
            return step.exercise.name in self.passed_exercises
        return step.number in self.completed_steps

    @property
    def next_step(self) -> LessonStep:
        """The first step that is not completed; the last one where all are."""
        return next(
            (step for step in self.lesson.steps if not self.is_step_completed(step)), self.lesson.steps[-1]
        )

    def opened_hint_count(self, exercise: Exercise, criterion: str) -> int:
        return self.opened_hints.get(f"{exercise.name}/{criterion}", 0)


def lesson_progress_from_events(lesson: Lesson, events: Sequence[ProgressEvent]) -> LessonProgress:
    """Computes the progress in a lesson; ``events`` may include those of other lessons."""
    steps: set[int] = set()
    predictions: dict[int, int] = {}
    best: dict[str, float] = {}
    attempts: dict[str, int] = {}
    passed: set[str] = set()
    hints: dict[str, int] = {}
    solutions: set[str] = set()
    defences: dict[str, int] = {}
    defended: set[str] = set()
    last = ""
    for event in events:
        name, _, rest = event.subject.partition("/")
        if name != lesson.name or not rest:
            continue
        content: Any = event.content
        match event.kind:
            case EventKind.STEP:
                steps.add(_step_number(rest))
            case EventKind.PREDICTION:
                predictions.setdefault(_step_number(rest), _whole_number(event, "chosen", -1))
            case EventKind.ATTEMPT if content.get("verdict") in ("pass", "fail"):
                attempts[rest] = attempts.get(rest, 0) + 1
                most = event.number("max_points") or 0.0
                share = (event.number("points") or 0.0) / most if most > 0 else 0.0
                best[rest] = max(best.get(rest, 0.0), min(share, 1.0))
                if content["verdict"] == "pass":
                    passed.add(rest)
            case EventKind.HINT:
                hints[rest] = max(hints.get(rest, 0), _whole_number(event, "step", 0))
            case EventKind.SOLUTION:
                solutions.add(rest)
            case EventKind.DEFENCE:
                defences[rest] = defences.get(rest, 0) + 1
                asked = _whole_number(event, "asked", 0)
                if 0 < asked == _whole_number(event, "right", -1):
                    defended.add(rest)
            case _:
                continue
        last = max(last, event.timestamp)
    return LessonProgress(
        lesson,
        frozenset(steps),
        predictions,
        best,
        attempts,
        frozenset(passed),
        hints,
        frozenset(solutions),
        defences,
        frozenset(defended),
        last,
    )


def _step_number(text: str) -> int:
    return int(text) if text.isdecimal() and len(text) <= MAX_STEP_DIGITS else 0


def _whole_number(event: ProgressEvent, key: str, otherwise: int) -> int:
    value = event.number(key)
    return otherwise if value is None else int(value)


@dataclass(frozen=True, slots=True)
class LessonEntry:
    """One lesson of the list."""

    name: str
    """The name of its folder: ``01-drive``."""
    number: str
    """Its number in the course: ``A2``."""
    progress: LessonProgress | None
    """The student's progress; None for a lesson that cannot be read."""
    problem: str = ""
    """Why the lesson cannot be read; else empty."""
    opened_unit: LessonUnit | None = None
    """The unit that begins with this lesson; None for the others."""

    @property
    def lesson(self) -> Lesson | None:
        return None if self.progress is None else self.progress.lesson

    @property
    def title(self) -> str:
        return self.name if self.lesson is None else self.lesson.title

    @property
    def is_completed(self) -> bool:
        return self.progress is not None and self.progress.is_completed

    @property
    def has_started(self) -> bool:
        return self.progress is not None and self.progress.has_started


def list_lessons(events: Sequence[ProgressEvent], folder: Path | None = None) -> tuple[LessonEntry, ...]:
    """Lists every lesson in order, including those that cannot be read. Raises FileNotFoundError where no lessons
    were installed."""
    folder = lessons_folder() if folder is None else folder
    openers = {unit.lessons[0]: unit for unit in read_units(folder) if unit.lessons}
    return tuple(
        replace(_read_entry(folder / name, events), opened_unit=openers.get(name))
        for name in lesson_names(folder)
    )


def next_lesson(entries: Sequence[LessonEntry]) -> LessonEntry | None:
    """Finds the lesson to continue with: the one worked on last, if it is not completed; else the first one after it
    that is not; else the first one at all that is not. None: all are completed."""
    last = max(
        (index for index, each in enumerate(entries) if each.has_started),
        key=lambda index: _last_activity(entries[index]),
        default=0,
    )
    ahead = (*entries[last:], *entries[:last])
    return next((each for each in ahead if each.progress is not None and not each.is_completed), None)


def _read_entry(folder: Path, events: Sequence[ProgressEvent]) -> LessonEntry:
    number = lesson_number(folder.name, folder.parent)
    try:
        return LessonEntry(folder.name, number, lesson_progress_from_events(read_lesson(folder), events))
    except (WorldError, OSError) as error:
        return LessonEntry(folder.name, number, None, str(error))


def _last_activity(entry: LessonEntry) -> str:
    return "" if entry.progress is None else entry.progress.last_activity
