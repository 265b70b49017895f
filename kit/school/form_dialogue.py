"""The evaluation form as a dialogue: one question at a time, its answer chosen or typed, and kept when the student goes on."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from types import MappingProxyType
from typing import Any, ClassVar, Final

from kit.dialogue.dialogue import Dialogue, DialogueAction, Panel, Refused, help_action, leave_action
from kit.dialogue.effects import Effect, Leave, StartTyping
from kit.dialogue.screen_action import ScreenAction, digits, letter
from kit.dialogue.shared_actions import ACTIONS
from kit.document.blocks import Block, Choice, Choices, RatingScale, Text, Tone
from kit.plain_text import counted, printable_line
from kit.school.form_answers import InvalidAnswer, parse_answer
from kit.school.form_session import PHASE_LABELS, FormSession
from kit.school.lessons.glossary import glossary_action
from kit.school.progress import ProgressError
from kit.school.survey import AnswerShape, AnswerValue, SurveyPhase, SurveyQuestion

KEPT: Final = (
    ("what is kept", "each answer, as soon as you go on, go back, leave or quit"),
    ("blank", "Enter without an answer; it is not counted"),
    ("who sees it", "your teacher, once you hand in your progress"),
)
BEFORE_CURRENT: Final = 3
"""Answered questions that are listed before the one that is asked."""
MOST_POINTS: Final = 7
"""Of a scale."""


class FormDialogue(Dialogue):
    """Asks what a session has ahead."""

    name = "form"
    help_title = "The form"
    help_notes = (KEPT,)
    failures = MappingProxyType({ProgressError: "Not saved: {}", InvalidAnswer: "Not saved: {}"})
    has_entry = True

    def __init__(self, session: FormSession) -> None:
        self.session = session
        self.chosen: int | None = None
        """Index of the chosen answer; None: blank."""
        self._text = ""
        """The answer as it is typed so far."""
        self._has_asked = session.question is not None
        self._come_to_question()

    def _come_to_question(self) -> None:
        question, value = self.session.question, self.session.value
        self._has_asked = self._has_asked or question is not None
        is_chosen = question is not None and value in question.values
        self.chosen = question.values.index(value) if question is not None and is_chosen else None
        self._text = str(value or "") if self.is_text else ""

    @property
    def is_text(self) -> bool:
        """Whether the answer to the question is typed."""
        return self.session.question is not None and self.session.question.shape is AnswerShape.TEXT

    @property
    def answer(self) -> AnswerValue:
        """The answer that is chosen or typed; None: it is blank. What is typed may still be none."""
        question = self.session.question
        if question is None:
            return None
        if self.is_text:
            return self._text or None
        return None if self.chosen is None else question.values[self.chosen]

    # What is shown

    @property
    def title(self) -> str:
        return self.session.form.title

    @property
    def position(self) -> str:
        if self.session.question is None:
            return ""
        return f"{PHASE_LABELS[self.session.phase]}, question {self.session.number} of {self.session.count}"

    @property
    def place(self) -> object:
        return None if self.session.question is None else self.session.question.id

    @property
    def is_over(self) -> bool:
        return self.session.question is None

    @property
    def note(self) -> Text | None:
        said = "Saved as you go on; nobody sees it before you hand it in."
        return None if self.is_over else Text(said, Tone.DIM)

    def opening(self) -> Sequence[Block]:
        session = self.session
        count = session.count if session.asks_again else session.open_count
        return (
            Text(f"{self.title} ({PHASE_LABELS[session.phase]}): {counted(count, 'question')}."),
            Text("Enter alone leaves a question blank.", is_tight=True),
        )

    def farewell(self) -> Sequence[Block]:
        if self.is_over:
            return ()
        left = counted(self.session.open_count, "question")
        return (Text(f"Saved. {left} left; `kit form {self.session.phase.value}` continues here."),)

    def arrival_blocks(self) -> Sequence[Block]:
        question = self.session.question
        if question is None or self.session.value is None:
            return ()
        return (
            Text(f"Your answer: {shown_answer(self.session.value, question)}. Enter keeps it, x clears it."),
        )

    def blocks(self) -> Sequence[Block]:
        question = self.session.question
        if question is None:
            return (Text(self.session.closing_text if self._has_asked else self.session.answered_text),)
        return self._question_blocks(question)

    def possible_blocks(self) -> Sequence[Sequence[Block]]:
        return [self._question_blocks(each) for each in self.session.questions]

    def _question_blocks(self, question: SurveyQuestion) -> Sequence[Block]:
        lead = [Text(question.group_text)] if question.group_text else []
        return (*lead, Text(question.text, Tone.BOLD), *self._answer_blocks(question))

    @property
    def has_panels(self) -> bool:
        return self.session.question is not None

    def panels(self) -> Sequence[Panel]:
        session = self.session
        kept = (Text(f"{lead}: {words}.", Tone.DIM, hang=2, is_tight=True) for lead, words in KEPT)
        first = max(0, session.number - 1 - BEFORE_CURRENT)
        entries = [
            block
            for number, each in enumerate(session.questions[first:], first + 1)
            for block in self._entry_of(number, each)
        ]
        shown = [
            Panel("your answers", tuple(kept)),
            Panel(f"the questions {PHASE_LABELS[session.phase]}", tuple(entries)),
        ]
        phases = list(SurveyPhase)
        for later in phases[phases.index(session.phase) + 1 :]:
            asked = dict.fromkeys(
                each.group_text or each.text for each in session.form.questions_in_phase(later)
            )
            told = (Text(each, Tone.DIM, lead="-", hang=2, is_tight=True) for each in asked)
            # Each column has one of two: both below the question leave the other half blank, and are cut on a lower screen.
            is_below = not any(each.is_below for each in shown)
            shown.append(Panel(f"asked {PHASE_LABELS[later]}", tuple(told), is_below=is_below))
        return shown

    def _entry_of(self, number: int, question: SurveyQuestion) -> tuple[Block, ...]:
        """A question in the list of all, and below it what was answered."""
        session = self.session
        is_current = question == session.question
        value = None if is_current else session.answers.value(question.id, session.phase)
        is_left_blank = (
            not is_current and value is None and session.answers.is_answered(question.id, session.phase)
        )
        lead = f"{'>' if is_current else ' '} {number:>2} "
        tone = Tone.BOLD if is_current else Tone.PLAIN if value is not None or is_left_blank else Tone.DIM
        shown = [Text(question.text, tone, lead=lead, lead_tone=tone, hang=6, is_tight=True)]
        if value is not None or is_left_blank:
            shown.append(Text(shown_answer(value, question), Tone.GOOD, indent=6, is_tight=True))
        return tuple(shown)

    def _answer_blocks(self, question: SurveyQuestion) -> list[Block]:
        match question.shape:
            case AnswerShape.TEXT:
                return []
            case AnswerShape.SCALE:
                points = tuple(int(str(each)) for each in question.values)
                return [RatingScale(points, question.low, question.high, self.chosen)]
            case AnswerShape.YES_NO:
                labels: Sequence[str] = ("yes", "no")
            case _:
                labels = question.shown_options or question.options
        entries = (
            Choice(str(index + 1), label, *((Tone.BOLD, ">") if index == self.chosen else ()))
            for index, label in enumerate(labels)
        )
        return [Choices(tuple(entries))]

    @property
    def block_in_view(self) -> Block | None:
        return self.blocks()[-1]  # the answers stand at the end

    # Typed text

    @property
    def entry(self) -> str | None:
        return self._text if self.is_text else None

    def take_draft(self, text: str) -> None:
        self._text = text

    def take_line(self, line: str) -> Effect:
        question = self.session.question
        if question is None:
            return super().take_line(line)
        self.session.answer(parse_answer(question, line))
        self._come_to_question()
        return None

    # What is done

    def pick(self, number: int) -> Effect:
        values = self._question.values
        if number > len(values):
            raise Refused(f"Choose 1 to {len(values)}.")
        self.chosen = number - 1
        return None

    def move(self, columns: int, rows: int) -> Effect:
        last, step = len(self._question.values) - 1, columns + rows
        start = (-1 if step > 0 else last + 1) if self.chosen is None else self.chosen
        self.chosen = min(max(start + step, 0), last)
        return None

    def start_typing(self) -> Effect:
        return StartTyping()

    def clear(self) -> Effect:
        self.chosen, self._text = None, ""
        return None

    def go_on(self) -> Effect:
        self.session.answer(self._checked_answer())
        self._come_to_question()
        return None

    def go_back(self) -> Effect:
        self._save_change()
        self.session.go_back()
        self._come_to_question()
        return None

    def leave(self) -> Effect:
        self._save_change()
        return Leave()

    def close(self) -> None:
        """Keeps what was chosen where the kit is quit, or its terminal closed, in the middle of a question."""
        with suppress(InvalidAnswer, ProgressError):  # nobody is there to be told
            self._save_change()

    @property
    def _question(self) -> SurveyQuestion:
        assert self.session.question is not None  # the actions that ask are not possible elsewhere
        return self.session.question

    def _checked_answer(self) -> AnswerValue:
        return parse_answer(self._question, self._text) if self.is_text else self.answer

    def _save_change(self) -> None:
        """Keeps what was changed at the question, before it is left other than to go on."""
        if self.session.question is not None and self.answer != self.session.value:
            self.session.save(self._checked_answer())

    # When

    def has_choices(self) -> bool:
        return self.session.question is not None and not self.is_text

    def is_asked(self) -> bool:
        return self.session.question is not None

    def can_go_back(self) -> bool | str:
        return self.session.number > 1 or "This is the first question."

    def has_answer(self) -> bool:
        return self.answer is not None

    def next_word(self) -> str:
        return "next" if self.has_answer() else "leave blank"

    def back_word(self) -> str:
        return "change answers" if self.is_over else "previous"

    def answer_keys(self) -> str:
        return f"1-{len(self._question.values)}"

    actions: ClassVar[Sequence[DialogueAction[Any]]] = (
        DialogueAction(
            ScreenAction("form_answer", "1 to 7", "answer", "choose an answer; Enter keeps it", digits("answer", 1, MOST_POINTS), "1-7"),
            pick, has_choices, shown_keys=answer_keys, then="form_next",
        ),
        DialogueAction(
            letter("type_answer", "e", "type", "type your answer; Esc ends typing, Enter keeps it"),
            start_typing, lambda dialogue: dialogue.is_text, is_for_lines=False,
        ),
        DialogueAction(
            ScreenAction("form_next", "Enter", "next", "go on; without an answer, it is left blank", (("enter", "next"),)),
            go_on, is_asked, word=next_word,
        ),
        DialogueAction(ACTIONS["choose"], move, has_choices, is_for_lines=False),
        DialogueAction(ACTIONS["previous"], go_back, can_go_back, word=back_word),
        DialogueAction(letter("clear_answer", "x", "clear", "clear the answer, so that Enter leaves it blank"), clear, has_answer, then="form_next"),
        help_action(),
        leave_action(leave),
        glossary_action(),
    )  # fmt: skip


def shown_answer(value: AnswerValue, question: SurveyQuestion) -> str:
    """An answer in words, an option of a choice in the form's language."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    shown = dict(zip(question.options, question.shown_options, strict=False)).get(str(value), value)
    return "blank" if shown is None else printable_line(str(shown))
