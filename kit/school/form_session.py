"""A session with the evaluation form: asks one question after the other, and keeps each answer before the next is asked."""

from __future__ import annotations

from collections.abc import Iterable
from datetime import datetime
from types import MappingProxyType
from typing import Final

from kit.school.form_answers import FormAnswers, asked_questions, open_questions
from kit.school.progress import EventKind, ProgressJournal
from kit.school.quiz.answers import AnswerOccasion, answers_from_events
from kit.school.survey import AnswerValue, SurveyForm, SurveyPhase, SurveyQuestion

PHASE_LABELS: Final = MappingProxyType(
    {
        SurveyPhase.BEFORE: "before the lessons",
        SurveyPhase.AFTER: "after the lessons",
        SurveyPhase.QUIZZED: "after the quiz",
    }
)
_NEXT_STEP: Final = MappingProxyType(
    {SurveyPhase.AFTER: " Now the quiz: `kit quiz`; then `kit form quizzed`, which is short."}
)


class FormSession:
    """Asks the open questions of one phase. ``again``: all of them, also the answered ones.

    Each answer can change which questions follow, so they are determined again each time. Raises ProgressError.
    """

    def __init__(
        self, form: SurveyForm, phase: SurveyPhase, journal: ProgressJournal, *, again: bool = False
    ) -> None:
        self.form = form
        self.phase = phase
        self._journal = journal
        self.asks_again = again
        self._shown: set[str] = set()
        """Ids of the questions that this session came to; going back and on again comes to them again."""
        self.answers = self._read_answers()
        self.question: SurveyQuestion | None = None
        """The current question; None: there is none left."""
        self._show_first(self.questions)

    @property
    def questions(self) -> list[SurveyQuestion]:
        """All questions that this student is asked, given the answers so far."""
        return asked_questions(self.form, self.answers, self.phase)

    @property
    def number(self) -> int:
        """Number of the current question, from 1; one more than there are questions where none is left."""
        asked = self.questions
        return len(asked) + 1 if self.question is None else asked.index(self.question) + 1

    @property
    def count(self) -> int:
        return len(self.questions)

    @property
    def open_count(self) -> int:
        """Number of questions that were neither answered nor left blank yet."""
        return len(open_questions(self.form, self.answers, self.phase))

    @property
    def value(self) -> AnswerValue:
        """The answer to the current question so far; None: none, or left blank."""
        return None if self.question is None else self.answers.value(self.question.id, self.phase)

    @property
    def closing_text(self) -> str:
        """What is said when nothing is left to ask."""
        return f"Thank you, that is all.{_NEXT_STEP.get(self.phase, '')}"

    @property
    def answered_text(self) -> str:
        """What is said where nothing was left to ask from the start."""
        return f"Every question of the form '{self.phase.value}' is answered."

    def save(self, value: AnswerValue) -> None:
        """Records the answer to the current question and stays there. It is on the disk when this returns. Raises
        ProgressError."""
        assert self.question is not None
        content = {"phase": self.phase.value, "value": value}
        self._journal.add(EventKind.FORM, self.question.id, content)
        self.answers = self._read_answers()

    def answer(self, value: AnswerValue) -> None:
        """Records the answer to the current question and moves on. Raises ProgressError."""
        assert self.question is not None
        self.save(value)
        asked = self.questions
        self._show_first(asked[asked.index(self.question) + 1 :])

    def go_back(self) -> bool:
        """Moves to the question before the current one; False if that is the first."""
        before = self.questions[: self.number - 1]
        if not before:
            return False
        self.question = before[-1]
        self._shown.add(self.question.id)
        return True

    def _show_first(self, questions: Iterable[SurveyQuestion]) -> None:
        """Moves to the first of these that is to be asked."""
        self.question = next((each for each in questions if self._is_to_be_asked(each)), None)
        if self.question is not None:
            self._shown.add(self.question.id)

    def _is_to_be_asked(self, question: SurveyQuestion) -> bool:
        is_answered = self.answers.is_answered(question.id, self.phase)
        return self.asks_again or not is_answered or question.id in self._shown

    def _read_answers(self) -> FormAnswers:
        return FormAnswers.from_events(self.form, self._journal.events(EventKind.FORM))


def current_phase(form: SurveyForm, journal: ProgressJournal) -> SurveyPhase:
    """Returns ``before`` until that part is done or a lesson was begun without it, then ``after``, then what follows the
    quiz. Raises ProgressError."""
    answers = FormAnswers.from_events(form, journal.events(EventKind.FORM))
    if answers.has_started(SurveyPhase.AFTER) and not open_questions(form, answers, SurveyPhase.AFTER):
        last = max(
            each.timestamp
            for each in journal.events(EventKind.FORM)
            if each.content.get("phase") == SurveyPhase.AFTER.value
        )
        quiz = [
            each
            for each in answers_from_events(journal.events(EventKind.ANSWER))
            if each.occasion is AnswerOccasion.QUIZ
        ]
        if any(each.time > datetime.fromisoformat(last) for each in quiz):
            return SurveyPhase.QUIZZED
    if answers.has_started(SurveyPhase.AFTER) or not open_questions(form, answers, SurveyPhase.BEFORE):
        return SurveyPhase.AFTER
    begun = answers.has_started(SurveyPhase.BEFORE) or not journal.events(EventKind.ATTEMPT)
    return SurveyPhase.BEFORE if begun else SurveyPhase.AFTER
