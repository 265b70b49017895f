"""The data of a class: its students, read from their exported files, with ratings, answers and work in the lessons."""

from __future__ import annotations

import hashlib
import math
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import timedelta
from pathlib import Path
from typing import Any, Final

import numpy as np

from kit.arrays import FloatArray
from kit.plain_text import counted, is_printable
from kit.school.form_answers import FormAnswers
from kit.school.progress import EventKind, ProgressError, ProgressEvent
from kit.school.progress_export import read_export
from kit.school.quiz.answers import AnswerOccasion, answer_from_event
from kit.school.report.measures import BLANK, AnswerSheet, ClassRatings, ItemReply, ReportItem
from kit.school.survey import AnswerShape, SurveyForm, SurveyPhase, SurveyQuestion

MAX_NAME_LENGTH: Final = 40


@dataclass(frozen=True, slots=True)
class Student:
    """One student, read from one or more files."""

    label: str
    """Label in the report: a number, or the name if names are wanted."""
    files: tuple[Path, ...]
    events: tuple[ProgressEvent, ...]
    """Sorted by time."""


@dataclass(frozen=True, slots=True)
class ClassRoster:
    """A class, with the warnings from reading its files."""

    students: tuple[Student, ...]
    file_count: int
    """Number of files found, readable or not."""
    warnings: tuple[str, ...]


@dataclass(slots=True)
class _StudentFiles:
    """A student while files are being merged."""

    files: list[Path]
    events: dict[str, ProgressEvent]
    name: str


def read_roster(paths: Sequence[Path], *, use_names: bool = False) -> ClassRoster:
    """Reads every file, and every ``.json`` file directly in a folder; skips those that cannot be read, with a warning.

    ``use_names``: students are labelled by the name they gave, else by their file's; otherwise S1, S2, ... in an
    order that does not identify them.
    """
    warnings: list[str] = []
    files = list(_list_files(paths, warnings))
    students_found: list[_StudentFiles] = []
    for file in files:
        _add_file(file, students_found, warnings)
    students_found.sort(key=lambda each: hashlib.sha256(min(each.events).encode()).digest())
    warnings += _same_name_warnings(students_found)
    width = len(str(len(students_found)))
    labels = [each.name or each.files[0].stem for each in students_found] if use_names else []
    labels = list(_unique_labels(labels)) or [
        f"S{number:0{width}}" for number in range(1, len(students_found) + 1)
    ]
    students = (
        Student(label, tuple(each.files), tuple(sorted(each.events.values(), key=lambda event: event.time)))
        for label, each in zip(labels, students_found, strict=True)
    )
    return ClassRoster(tuple(sorted(students, key=lambda each: each.label)), len(files), tuple(warnings))


def _list_files(paths: Iterable[Path], warnings: list[str]) -> Iterator[Path]:
    """Yields each file once, also where several paths name it."""
    seen: set[Path] = set()
    for path in paths:
        inside = sorted(path.glob("*.json")) if path.is_dir() else [path]
        if not inside:
            warnings.append(f"{path}: there is no .json file in this folder.")
        for file in inside:
            real = file.resolve()
            if real in seen:
                warnings.append(f"{file}: was named twice, and is read once.")
            else:
                seen.add(real)
                yield file


def _add_file(file: Path, students: list[_StudentFiles], warnings: list[str]) -> None:
    """Reads a file, and merges it with the student with whom it shares events, if there is one."""
    try:
        events = {event.uid: event for event in read_export(file)}
    except ProgressError as error:
        warnings.append(f"{error} It is left out.")
        return
    except (RecursionError, OSError) as error:
        warnings.append(f"{file}: is not an export of progress ({error}). It is left out.")
        return
    if not events:
        warnings.append(f"{file}: contains no entries yet. It is left out.")
        return
    name = _student_name(events.values())
    for other in students:
        shared = events.keys() & other.events.keys()
        if not shared:
            continue
        if name and other.name and name != other.name:
            warnings.append(
                f"{file}: shares {counted(len(shared), 'entry')} with {other.files[0]}, but they name different students. "
                "They are kept apart, and count what they share twice."
            )
            continue
        warnings.append(
            f"{file}: is of the same student as {other.files[0]} ({counted(len(shared), 'entry')} in common). "
            "The two are put together."
        )
        other.files.append(file)
        other.events.update(events)
        other.name = _student_name(other.events.values())
        return
    students.append(_StudentFiles([file], events, name))


def _student_name(events: Iterable[ProgressEvent]) -> str:
    """The name that the student gave last; empty if none."""
    name_events = [each for each in events if each.kind is EventKind.ABOUT and each.subject == "name"]
    last = max(name_events, key=lambda each: each.time, default=None)
    value = last.content.get("value") if last is not None else None
    if not isinstance(value, str):
        return ""
    return "".join(c if is_printable(c) else " " for c in value).strip()[:MAX_NAME_LENGTH]


def _same_name_warnings(students: Sequence[_StudentFiles]) -> Iterator[str]:
    by_name: dict[str, list[_StudentFiles]] = {}
    for each in students:
        by_name.setdefault(each.name.casefold(), []).append(each)
    for name, some in sorted(by_name.items()):
        if name and len(some) > 1:
            files = ", ".join(sorted(str(each.files[0]) for each in some))
            yield (
                f"{files}: give the same name but share no entry. They count as {len(some)} students; "
                "leave one file out if it is one student who started over."
            )


def _unique_labels(labels: Sequence[str]) -> Iterator[str]:
    """Makes labels unique by numbering repeated ones."""
    count: dict[str, int] = {}
    for label in labels:
        count[label] = count.get(label, 0) + 1
        yield label if count[label] == 1 else f"{label} ({count[label]})"


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


@dataclass(frozen=True, slots=True)
class FreeTextAnswer:
    """One student's answer in free text."""

    question: SurveyQuestion
    student: str
    text: str


@dataclass(frozen=True, slots=True, eq=False)
class ClassData:
    """The data of a class. All arrays are in the order of ``names``."""

    names: tuple[str, ...]
    ratings: ClassRatings
    quiz: AnswerSheet
    """First answers of the students who took the quiz."""
    later_quiz: AnswerSheet
    """The newest answers to the same items, on any occasion; None where there is only the first one."""
    bank: AnswerSheet
    """First answers to items that only lessons and practice ask; None where an item was not asked."""
    work: tuple[StudentWork, ...]
    free_text_answers: tuple[FreeTextAnswer, ...]
    option_counts: tuple[tuple[SurveyQuestion, SurveyPhase, Mapping[str, int]], ...]
    """Yes-or-no and choice questions: number of students per answer."""
    warnings: tuple[str, ...]


def build_class_data(
    roster: ClassRoster, form: SurveyForm, known_items: Mapping[str, ReportItem] | None = None
) -> ClassData:
    """Builds the data of a class. ``known_items``: items of the quiz with their texts, in the order of the report."""
    known_items = known_items or {}
    names = tuple(each.label for each in roster.students)
    answers = [FormAnswers.from_events(form, each.events) for each in roster.students]
    warnings = list(roster.warnings)
    warnings += _invalid_answer_warnings(roster.students, answers)
    student_answers = [_StudentAnswers(each.events) for each in roster.students]
    warnings += _unknown_item_warnings(roster.students, student_answers, known_items)
    quiz, later, bank = _answer_sheets(student_answers, known_items)
    return ClassData(
        names,
        _class_ratings(form, answers),
        quiz,
        later,
        bank,
        tuple(student_work(each.events) for each in roster.students),
        tuple(_free_text_answers(form, names, answers)),
        tuple(_option_counts(form, answers)),
        tuple(warnings),
    )


def _class_ratings(form: SurveyForm, answers: Sequence[FormAnswers]) -> ClassRatings:
    values: dict[tuple[SurveyPhase, str], FloatArray] = {}
    for question in form.questions:
        if question.shape is AnswerShape.SCALE:
            for phase in question.phases:
                given = [each.value(question.id, phase) for each in answers]
                values[phase, question.id] = np.array(
                    [float(each) if isinstance(each, int) else np.nan for each in given]
                )
    return ClassRatings(form.questions, values)


def _free_text_answers(
    form: SurveyForm, names: Sequence[str], answers: Sequence[FormAnswers]
) -> list[FreeTextAnswer]:
    return [
        FreeTextAnswer(question, name, value)
        for question in form.questions
        if question.shape is AnswerShape.TEXT
        for phase in question.phases
        for name, given in zip(names, answers, strict=True)
        if isinstance(value := given.value(question.id, phase), str) and value.strip()
    ]


def _option_counts(
    form: SurveyForm, answers: Sequence[FormAnswers]
) -> list[tuple[SurveyQuestion, SurveyPhase, Mapping[str, int]]]:
    counts: list[tuple[SurveyQuestion, SurveyPhase, Mapping[str, int]]] = []
    for question in form.questions:
        options = question.options if question.shape is AnswerShape.CHOICE else ("yes", "no")
        if question.shape not in (AnswerShape.CHOICE, AnswerShape.YES_NO):
            continue
        for phase in question.phases:
            asked = [
                each.value(question.id, phase) for each in answers if each.is_answered(question.id, phase)
            ]
            words = [
                "blank" if v is None else v if isinstance(v, str) else "yes" if v else "no" for v in asked
            ]
            if words:
                counts.append((question, phase, {word: words.count(word) for word in (*options, "blank")}))
    return counts


class _StudentAnswers:
    """One student's replies by item: those in the quiz, the first ones, and the newest ones given after the quiz."""

    def __init__(self, events: Sequence[ProgressEvent]) -> None:
        self.quiz_replies: dict[str, ItemReply] = {}
        self.first_replies: dict[str, ItemReply] = {}
        self.later_replies: dict[str, ItemReply] = {}
        self.topics: dict[str, str] = {}
        for event in events:
            try:
                answer = answer_from_event(event)
            except TypeError:  # malformed content, such as a list in place of a number
                answer = None
            if answer is None:
                continue
            chosen = event.content.get("chosen")
            reply = ItemReply(answer.outcome, chosen if isinstance(chosen, int) else None)
            topic = event.content.get("topic")
            self.topics[answer.item] = topic if isinstance(topic, str) else "other"
            self.first_replies.setdefault(answer.item, reply)
            if answer.item in self.quiz_replies:
                self.later_replies[answer.item] = reply
            elif answer.occasion is AnswerOccasion.QUIZ:
                self.quiz_replies[answer.item] = reply


def _invalid_answer_warnings(students: Sequence[Student], answers: Sequence[FormAnswers]) -> Iterator[str]:
    """Warnings about invalid form answers, sorted by file so that they do not identify students."""
    for file, odd in sorted(
        (each.files[0], given.invalid_questions) for each, given in zip(students, answers, strict=True)
    ):
        if odd:
            yield (
                f"{file}: {len(odd)} answers of the form cannot be answers to their questions "
                f"({', '.join(odd[:3])}{', ...' if len(odd) > 3 else ''}). They are left out."
            )


def _unknown_item_warnings(
    students: Sequence[Student],
    student_answers: Sequence[_StudentAnswers],
    known_items: Mapping[str, ReportItem],
) -> Iterator[str]:
    """Warnings about answers to questions that this kit does not have."""
    if not known_items:
        return
    found = [
        (student.files[0], sheet.topics.keys() - known_items.keys())
        for student, sheet in zip(students, student_answers, strict=True)
    ]
    files = sorted(str(file) for file, unknown in found if unknown)
    if files:
        questions = {name for _, unknown in found for name in unknown}
        yield (
            f"{', '.join(files[:3])}{f' and {len(files) - 3} more' if len(files) > 3 else ''}: "
            f"{len(questions)} of the questions answered there are not in this kit. They are left out; was another "
            "version used?"
        )


def _answer_sheets(
    student_answers: Sequence[_StudentAnswers], known_items: Mapping[str, ReportItem]
) -> tuple[AnswerSheet, AnswerSheet, AnswerSheet]:
    """Answer sheets: the quiz by first answers, the same items by newest ones, and the other items."""
    topics = {name: topic for sheet in student_answers for name, topic in sheet.topics.items()}
    answered = {name for sheet in student_answers for name in sheet.quiz_replies}
    if known_items:
        items = [item for name, item in known_items.items() if name in topics]
        asked = tuple(item for item in items if item.in_quiz and item.id in answered)
    else:
        items = [
            ReportItem(name, topic) for name, topic in sorted(topics.items(), key=lambda pair: pair[::-1])
        ]
        asked = tuple(item for item in items if item.id in answered)
    rest = tuple(item for item in items if item not in asked)
    return (
        # A student who took the quiz could have answered every item: those not reached count as blank.
        AnswerSheet(
            asked,
            {
                i.id: tuple(
                    s.quiz_replies.get(i.id, BLANK) if s.quiz_replies else None for s in student_answers
                )
                for i in asked
            },
        ),
        AnswerSheet(asked, {i.id: tuple(s.later_replies.get(i.id) for s in student_answers) for i in asked}),
        AnswerSheet(rest, {i.id: tuple(s.first_replies.get(i.id) for s in student_answers) for i in rest}),
    )
