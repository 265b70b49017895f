"""Turns a roster of students into the data of a class: ratings, the quiz's answer sheet, work in the lessons."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from kit.kernels.arrays import Float64Array
from kit.school.progress import ProgressEvent
from kit.school.quiz.schedule import AnswerOccasion, answer_from_event
from kit.school.report.measures import BLANK, AnswerSheet, ClassRatings, ItemReply, ReportItem
from kit.school.report.students import ClassRoster, Student, StudentWork, student_work
from kit.school.survey.form_session import FormAnswers
from kit.school.survey.reading import AnswerShape, SurveyForm, SurveyPhase, SurveyQuestion


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
    values: dict[tuple[SurveyPhase, str], Float64Array] = {}
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
