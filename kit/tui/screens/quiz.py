"""The quiz: a question, how sure the student is, and the feedback; one key each, and nothing moves by itself.

The quiz, opened from another screen: which questions, and what is said where there is nothing to ask.
"""

from __future__ import annotations

from asyncio import to_thread
from enum import Enum
from typing import Any, ClassVar, Final

from textual import events
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.screen import Screen

from kit.dialogue.actions import ScreenAction, ScreenActions, digits, letter
from kit.document.rows import Row, row, spread, window
from kit.school.lessons.reading import lesson_number, lesson_title
from kit.school.progress import ProgressError, ProgressJournal
from kit.school.quiz.items import OPTION_COUNT, QuestionBank, QuizItem, read_bank
from kit.school.quiz.quiz_session import (
    PracticePlan,
    QuestionPlan,
    QuizSession,
    lesson_plan,
    local_now,
    quiz_plan,
    student_seed,
)
from kit.school.quiz.quiz_text import closing_lines, scores_lines, today_line
from kit.school.quiz.schedule import (
    BLANK,
    CONFIDENCE_LABELS,
    NOT_SURE,
    AnswerChoice,
    answers_from_events,
    build_schedule,
)
from kit.tui.rows.key_rows import bindings, footer
from kit.tui.rows.quiz_rows import ROOMY_ROWS, centred, option_rows, question_rows, sure_rows, told_rows
from kit.tui.screens.dialogs import HelpDialog, MessageDialog, Picker, PickerItem, TextScreen, wrapped
from kit.tui.widgets.text_rows import RowsScreen, TextRows
from kit.world.problems import WorldError


class QuizStage(Enum):
    """How far one is with a question."""

    ASKED = "asked"
    CHOSEN = "chosen"
    TOLD = "told"
    OVER = "over"


_ALWAYS: Final = ("answer", "confidence", "not_sure", "skip", "next", "previous")
_IDLE: Final = {
    stage: tuple(each for each in _ALWAYS if each not in ids)
    for stage, ids in {
        QuizStage.ASKED: ("answer", "not_sure", "skip"),
        QuizStage.CHOSEN: ("confidence", "previous"),
        QuizStage.TOLD: ("next",),
        QuizStage.OVER: (),
    }.items()
}
"""Actions that do nothing in a stage."""
MARKS: Final = (
    (">", "your choice"),
    ("+", "the right answer"),
    ("x", "your choice, where it is wrong"),
)
KEPT: Final = (
    ("what is kept", "every answer, once you have said how sure you are"),
    ("what comes back", "topics, after 1, 3, 7 and 21 days: kit quiz --today"),
)


class QuizScreen(RowsScreen[None]):
    """Asks what a sitting has ahead. Draws nothing but what a key has changed."""

    AUTO_FOCUS = ""
    screen_actions = ScreenActions(
        "quiz",
        ("answer", "confidence", "not_sure", "skip", "next", "previous", "help", "back"),
        ("scroll",),
        own=(
            ScreenAction("answer", "1 2 3", "answer", "choose an answer, then say how sure you are", digits("answer", 1, 4), "1-3"),
            ScreenAction("confidence", "1 2 3 4", "how sure", "say how sure you are of your answer", (), "1-4"),
            ScreenAction("not_sure", "0", "not sure", "say that you do not know; not counted as wrong", (("0", "answer(0)"),)),
            letter("skip", "x", "leave blank", "leave the question blank; press it twice"),
        ),
    )  # fmt: skip
    BINDINGS: ClassVar[list[BindingType]] = bindings(screen_actions)
    DEFAULT_CSS = """
    QuizScreen { layout: vertical; }
    QuizScreen #heading, QuizScreen #remark, QuizScreen #keys { height: 1; }
    QuizScreen #body { height: 1fr; }
    """

    def __init__(self, session: QuizSession) -> None:
        super().__init__()
        self._sitting = session
        self._item: QuizItem | None = session.current_item
        self._number = session.question_number
        self._choice: AnswerChoice | None = None
        self._top = 0
        self._asked_to_skip = False
        self.stage = QuizStage.ASKED if self._item is not None else QuizStage.OVER

    def compose(self) -> ComposeResult:
        yield TextRows(id="heading")
        yield TextRows(id="body")
        yield TextRows(id="remark")
        yield TextRows(id="keys")

    def on_resize(self, event: events.Resize) -> None:
        self.call_after_refresh(self._show)

    # What is shown

    def _show(self, remark: Row = ()) -> None:
        if not self.size.width:
            return
        room = max(1, self.size.height - 3)
        body, self._top = window(self._body(is_roomy=room >= ROOMY_ROWS), self._top, room)
        body = centred(body, self.size.width, room)
        self._rows("heading").show([self._heading()])
        self._rows("body").show(body)
        self._rows("remark").show([remark])
        last = self.stage is QuizStage.TOLD and self._sitting.current_item is None
        labels = {"next": "results"} if last else {}
        self._rows("keys").show(
            [footer(self.screen_actions, self.size.width, without=_IDLE[self.stage], labels=labels)]
        )

    def _heading(self) -> Row:
        title = row((self._sitting.plan.title, "bold"))
        if self._item is None or self.stage is QuizStage.OVER:
            return title
        place = f"{self._item.topic.label}, question {self._number} of {max(self._number, self._sitting.question_count)}"
        return spread(title, row((place, "dim")), self.size.width)

    def _body(self, *, is_roomy: bool) -> list[Row]:
        width = self.size.width
        if self._item is None or self.stage is QuizStage.OVER:
            return [row(), *(row(f"  {line}".rstrip()) for line in closing_lines(self._sitting))]
        told = self.stage is QuizStage.TOLD
        rows = [row(), *question_rows(self._item, width)]
        rows += option_rows(self._item, width, self._choice, told=told, is_roomy=is_roomy)
        if self.stage is QuizStage.CHOSEN:
            rows += sure_rows()
        elif told and self._choice is not None:
            rows += told_rows(self._item, self._choice, width, is_roomy=is_roomy)
        return rows

    # Keys

    def action_answer(self, number: int) -> None:
        if self.stage is QuizStage.ASKED and number == 0:
            self._save_answer(NOT_SURE)
        elif self.stage is QuizStage.ASKED and number <= OPTION_COUNT:
            self._choice = AnswerChoice(number - 1)
            self._enter_stage(QuizStage.CHOSEN)
        elif self.stage is QuizStage.CHOSEN and number in CONFIDENCE_LABELS and self._choice is not None:
            self._save_answer(self._choice, number)

    def action_skip(self) -> None:
        if self.stage is not QuizStage.ASKED:
            return
        if self._asked_to_skip:
            self._save_answer(BLANK)
        else:
            self._asked_to_skip = True
            self._show(row(("  x once more leaves it blank; 0 says that you are not sure", "warn")))

    def action_previous(self) -> None:
        if self.stage is QuizStage.CHOSEN:
            self._choice = None
            self._enter_stage(QuizStage.ASKED)

    def action_next(self) -> None:
        if self.stage is not QuizStage.TOLD:
            return
        self._item = self._sitting.current_item
        self._number = self._sitting.question_number
        self._choice = None
        self._enter_stage(QuizStage.OVER if self._item is None else QuizStage.ASKED)

    def action_scroll(self, lines: int) -> None:
        self._top += lines
        self._show()

    def action_help(self) -> None:
        self.app.push_screen(
            HelpDialog("The quiz", self.screen_actions, MARKS, KEPT, without=("confidence",))
        )

    def _save_answer(self, choice: AnswerChoice, confidence: int | None = None) -> None:
        """The answer goes to the disk; only then is anything said of it."""
        try:
            self._sitting.answer(choice, confidence)
        except ProgressError as error:
            self._show(row((f"  Not saved: {error}", "bad")))
            return
        self._choice = choice
        self._enter_stage(QuizStage.TOLD)

    def _enter_stage(self, stage: QuizStage) -> None:
        self.stage = stage
        self._asked_to_skip = False
        if stage is not QuizStage.TOLD:
            self._top = 0
        else:
            self._top = 10_000  # what is said stands at the end; where all fits, that is the top
        self._show()


TWELVE, TODAY, SCORES = "twelve", "today", "scores"


async def ask_of_lesson(screen: Screen[Any], journal: ProgressJournal, lesson: str) -> None:
    """Asks a lesson's questions, and comes back. To be called in a worker."""
    bank = await _bank(screen)
    if bank is not None:
        await _ask(screen, journal, bank, lesson_plan(bank, lesson))


async def choose_questions(screen: Screen[Any], journal: ProgressJournal) -> None:
    """Has the student choose what to be asked, and asks it. To be called in a worker."""
    bank = await _bank(screen)
    if bank is None:
        return
    try:
        events = journal.events()
    except ProgressError as error:
        screen.app.push_screen(MessageDialog("Progress cannot be read", wrapped(str(error))))
        return
    schedule = build_schedule(bank, events, local_now())
    plans: dict[str, QuestionPlan] = {TODAY: PracticePlan(bank), TWELVE: quiz_plan(bank)}
    choices = [
        PickerItem(TODAY, "today", today_line(schedule)),
        PickerItem(TWELVE, "the twelve", "The twelve ideas, one question each."),
        PickerItem(SCORES, "scores", "What you know by topic, and how well you judge it."),
    ]
    lesson_plans = await to_thread(_lesson_plans, bank)
    plans |= lesson_plans
    choices += [
        PickerItem(name, f"lesson {lesson_number(name)}", lesson_title(name)) for name in lesson_plans
    ]
    chosen = await screen.app.push_screen_wait(Picker("Questions", choices))
    if chosen == SCORES:
        lines = scores_lines(bank, answers_from_events(events), schedule)
        await screen.app.push_screen_wait(TextScreen("Scores", [row(" " + line) for line in lines]))
    elif chosen is not None:
        await _ask(screen, journal, bank, plans[chosen])


def _lesson_plans(bank: QuestionBank) -> dict[str, QuestionPlan]:
    """The plan of each lesson with questions. Slow: reads the titles of the lessons."""
    return {name: lesson_plan(bank, name) for name in bank.lessons}


async def _bank(screen: Screen[Any]) -> QuestionBank | None:
    """Read in another thread: there are many files."""
    try:
        return await to_thread(read_bank)
    except (WorldError, FileNotFoundError) as error:
        screen.app.push_screen(MessageDialog("The questions cannot be read", wrapped(str(error))))
        return None


async def _ask(screen: Screen[Any], journal: ProgressJournal, bank: QuestionBank, plan: QuestionPlan) -> None:
    try:
        session = QuizSession(journal, bank, plan, seed=student_seed(journal))
        if session.current_item is None:  # all were asked: once more, for practice
            session = QuizSession(journal, bank, plan, seed=student_seed(journal), restart=True)
    except ProgressError as error:
        screen.app.push_screen(MessageDialog("Progress cannot be saved", wrapped(str(error))))
        return
    if session.current_item is None:
        screen.app.push_screen(
            MessageDialog(plan.title, wrapped("There is nothing to ask now. Come back another day."))
        )
        return
    await screen.app.push_screen_wait(QuizScreen(session))
