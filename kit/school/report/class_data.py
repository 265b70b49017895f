"""A roll of students becomes the numbers of a class: ratings, the answer sheet of the quiz, the work of each."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from kit.kernels.arrays import Float64Array
from kit.school.progress import ProgressEvent
from kit.school.quiz.answers import Occasion, answer_from_event
from kit.school.report.measures import BLANK, AnswerSheet, ClassRatings, ItemReply, ReportItem
from kit.school.report.students import ClassRoster, Student
from kit.school.report.work import StudentWork, student_work
from kit.school.survey.form_session import FormAnswers
from kit.school.survey.questions import AnswerShape, SurveyForm, SurveyPhase, SurveyQuestion


@dataclass(frozen=True, slots=True)
class FreeTextAnswer:
    """What somebody wrote."""

    question: SurveyQuestion
    student: str
    text: str


@dataclass(frozen=True, slots=True, eq=False)
class ClassData:
    """A class as numbers. All arrays are in the order of ``names``."""

    names: tuple[str, ...]
    ratings: ClassRatings
    quiz: AnswerSheet
    """First answers of who took the quiz."""
    later_quiz: AnswerSheet
    """The newest answers to the same items, from any occasion; None where there is none but the first."""
    bank: AnswerSheet
    """First answers to the items that only lessons and repetition ask; None where one was not asked."""
    work: tuple[StudentWork, ...]
    free_text_answers: tuple[FreeTextAnswer, ...]
    option_counts: tuple[tuple[SurveyQuestion, SurveyPhase, Mapping[str, int]], ...]
    """Questions of yes or no and of choice: how often each answer came."""
    warnings: tuple[str, ...]


def build_class_data(
    roster: ClassRoster, form: SurveyForm, known: Mapping[str, ReportItem] | None = None
) -> ClassData:
    """``known``: items of the quiz with their texts, in the order in which they are to be shown."""
    known = known or {}
    names = tuple(each.label for each in roster.students)
    answers = [FormAnswers.from_events(form, each.events) for each in roster.students]
    cautions = list(roster.warnings)
    cautions += _invalid_answer_warnings(roster.students, answers)
    sheets = [_StudentAnswers(each.events) for each in roster.students]
    cautions += _unknown_item_warnings(roster.students, sheets, known)
    quiz, later, bank = _answer_sheets(sheets, known)
    return ClassData(
        names,
        _ratings(form, answers),
        quiz,
        later,
        bank,
        tuple(student_work(each.events) for each in roster.students),
        tuple(_free_text_answers(form, names, answers)),
        tuple(_option_counts(form, answers)),
        tuple(cautions),
    )


def _ratings(form: SurveyForm, answers: Sequence[FormAnswers]) -> ClassRatings:
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
    found: list[tuple[SurveyQuestion, SurveyPhase, Mapping[str, int]]] = []
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
                found.append((question, phase, {word: words.count(word) for word in (*options, "blank")}))
    return found


class _StudentAnswers:
    """One student's answers, sorted: in the quiz, first of all, and the newest of those given after the quiz."""

    def __init__(self, events: Sequence[ProgressEvent]) -> None:
        self.quiz: dict[str, ItemReply] = {}
        self.first: dict[str, ItemReply] = {}
        self.again: dict[str, ItemReply] = {}
        self.topics: dict[str, str] = {}
        for event in events:
            try:
                answer = answer_from_event(event)
            except TypeError:  # a list, say, where a number belongs
                answer = None
            if answer is None:
                continue
            chosen = event.content.get("chosen")
            reply = ItemReply(answer.outcome, chosen if isinstance(chosen, int) else None)
            topic = event.content.get("topic")
            self.topics[answer.item] = topic if isinstance(topic, str) else "other"
            self.first.setdefault(answer.item, reply)
            if answer.item in self.quiz:
                self.again[answer.item] = reply
            elif answer.occasion is Occasion.QUIZ:
                self.quiz[answer.item] = reply


def _invalid_answer_warnings(students: Sequence[Student], answers: Sequence[FormAnswers]) -> Iterator[str]:
    """Answers of the form that cannot be. By file, so that nobody learns which student is which."""
    for file, odd in sorted(
        (each.files[0], given.invalid_questions) for each, given in zip(students, answers, strict=True)
    ):
        if odd:
            yield (
                f"{file}: {len(odd)} answers of the form cannot be answers to their questions "
                f"({', '.join(odd[:3])}{', ...' if len(odd) > 3 else ''}). They are left out."
            )


def _unknown_item_warnings(
    students: Sequence[Student], sheets: Sequence[_StudentAnswers], known: Mapping[str, ReportItem]
) -> Iterator[str]:
    """Answers to questions that this kit does not have, so that nobody else could give any."""
    if not known:
        return
    found = [
        (student.files[0], sheet.topics.keys() - known.keys())
        for student, sheet in zip(students, sheets, strict=True)
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
    sheets: Sequence[_StudentAnswers], known: Mapping[str, ReportItem]
) -> tuple[AnswerSheet, AnswerSheet, AnswerSheet]:
    """The quiz by first answers, the same items by newest ones, and the rest of the bank."""
    found = {name: topic for sheet in sheets for name, topic in sheet.topics.items()}
    answered = {name for sheet in sheets for name in sheet.quiz}
    if known:
        items = [item for name, item in known.items() if name in found]
        asked = tuple(item for item in items if item.in_quiz and item.id in answered)
    else:
        items = [
            ReportItem(name, topic) for name, topic in sorted(found.items(), key=lambda pair: pair[::-1])
        ]
        asked = tuple(item for item in items if item.id in answered)
    rest = tuple(item for item in items if item not in asked)
    return (
        # Who took the quiz at all had every item before them: what they did not reach is blank.
        AnswerSheet(
            asked, {i.id: tuple(s.quiz.get(i.id, BLANK) if s.quiz else None for s in sheets) for i in asked}
        ),
        AnswerSheet(asked, {i.id: tuple(s.again.get(i.id) for s in sheets) for i in asked}),
        AnswerSheet(rest, {i.id: tuple(s.first.get(i.id) for s in sheets) for i in rest}),
    )
