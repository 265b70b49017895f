"""Students' work in the lessons: completed steps, attempts, points and time."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import timedelta
from typing import Any, Final

from kit.school.progress import EventKind, ProgressEvent

MAX_IDLE: Final = timedelta(minutes=10)
"""A longer gap between two events counts as a break, not as working time."""

_OF_LESSONS: Final = frozenset(
    {
        EventKind.STEP,
        EventKind.PREDICTION,
        EventKind.ATTEMPT,
        EventKind.HINT,
        EventKind.SOLUTION,
        EventKind.DEFENCE,
    }
)


@dataclass(slots=True)
class ExerciseWork:
    """One exercise of one student."""

    attempts: int = 0
    """Number of attempts, without checks that broke."""
    points: float = 0.0
    """Points of the best attempt."""
    max_points: float = 0.0
    is_passed: bool = False
    tries_to_pass: int | None = None
    lost_criteria: Counter[str] = field(default_factory=Counter)
    """Criterion id -> number of attempts that lost it."""
    hints: int = 0
    has_seen_solution: bool = False
    defences: int = 0
    """Number of times that questions about the own program were answered."""
    is_defended: bool = False
    """Whether all of them were right once."""


@dataclass(slots=True)
class LessonWork:
    """One lesson of one student."""

    steps: set[str] = field(default_factory=set)
    minutes: float = 0.0
    predictions: int = 0
    predicted_right: int = 0
    exercises: dict[str, ExerciseWork] = field(default_factory=dict)

    @property
    def attempt_count(self) -> int:
        return sum(each.attempts for each in self.exercises.values())

    @property
    def hint_count(self) -> int:
        return sum(each.hints for each in self.exercises.values())

    @property
    def points(self) -> float:
        return sum(each.points for each in self.exercises.values())

    @property
    def max_points(self) -> float:
        """Sum over the exercises that were tried."""
        return sum(each.max_points for each in self.exercises.values())

    @property
    def defended_count(self) -> int:
        return sum(each.is_defended for each in self.exercises.values())

    @property
    def defence_count(self) -> int:
        return sum(each.defences for each in self.exercises.values())

    @property
    def passed_count(self) -> int:
        return sum(each.is_passed for each in self.exercises.values())


StudentWork = Mapping[str, LessonWork]
"""Lesson name -> work."""


def student_work(events: Sequence[ProgressEvent]) -> StudentWork:
    """Computes one student's work; ``events`` must be sorted by time."""
    lessons: dict[str, LessonWork] = {}
    before: tuple[str, ProgressEvent] | None = None
    for event in events:
        if event.kind not in _OF_LESSONS:
            continue
        name, _, rest = event.subject.partition("/")
        lesson = lessons.setdefault(name, LessonWork())
        if before is not None and before[0] == name and event.time - before[1].time <= MAX_IDLE:
            lesson.minutes += (event.time - before[1].time).total_seconds() / 60
        before = name, event
        _add_event(lesson, event.kind, rest, event.content)
    return lessons


def _add_event(lesson: LessonWork, kind: EventKind, rest: str, content: Mapping[str, Any]) -> None:
    if kind is EventKind.STEP:
        lesson.steps.add(rest)
    elif kind is EventKind.PREDICTION:
        lesson.predictions += 1
        lesson.predicted_right += content.get("right") is True
    else:
        exercise = lesson.exercises.setdefault(rest.partition("/")[0], ExerciseWork())
        if kind is EventKind.ATTEMPT:
            _add_attempt(exercise, content)
        elif kind is EventKind.HINT:
            exercise.hints += 1
        elif kind is EventKind.DEFENCE:
            exercise.defences += 1
            right = _non_negative_number(content.get("right"))
            exercise.is_defended |= right > 0 and right == _non_negative_number(content.get("asked"))
        else:
            exercise.has_seen_solution = True


def _add_attempt(exercise: ExerciseWork, content: Mapping[str, Any]) -> None:
    verdict = content.get("verdict")
    if verdict not in ("pass", "fail"):
        return  # the check itself broke, or the content is malformed
    exercise.attempts += 1
    most = _non_negative_number(content.get("max_points"))
    exercise.max_points = max(exercise.max_points, most)
    exercise.points = max(exercise.points, min(_non_negative_number(content.get("points")), most))
    if verdict == "pass" and not exercise.is_passed:
        exercise.is_passed, exercise.tries_to_pass = True, exercise.attempts
    lost = content.get("lost")
    if isinstance(lost, list):
        exercise.lost_criteria.update({each for each in lost if isinstance(each, str)})


def _non_negative_number(value: object) -> float:
    """A finite number of at least 0; 0 for anything else."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return 0.0
    try:
        number = float(value)
    except OverflowError:
        return 0.0
    return max(0.0, number) if math.isfinite(number) else 0.0


def started_lessons(works: Iterable[StudentWork]) -> tuple[str, ...]:
    """Names of the lessons that any student has started, sorted."""
    return tuple(sorted({name for work in works for name in work}))
