"""The evaluation form: one question at a time, its answer chosen or typed, and kept when the student goes on.

The form, opened from another screen.
"""

from __future__ import annotations

import textwrap
from asyncio import to_thread
from typing import Any, ClassVar, Final

from textual import events
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.screen import Screen

from kit.dialogue.actions import ScreenAction, ScreenActions, digits, letter
from kit.document.rows import MARGIN, Row, row, spread, text_width, window
from kit.school.form_session import PHASE_LABELS, FormSession, current_phase
from kit.school.progress import ProgressError, ProgressJournal
from kit.school.survey import AnswerShape, AnswerValue, InvalidAnswer, parse_answer, read_form
from kit.tui.rows.form_rows import question_rows
from kit.tui.rows.key_rows import bindings, footer
from kit.tui.rows.quiz_rows import WIDEST_TEXT, centred, left_column
from kit.tui.screens.dialogs import HelpDialog, MessageDialog, wrapped
from kit.tui.textual_patches import ActivePaintScreen
from kit.tui.widgets.text_field import AnswerField
from kit.tui.widgets.text_rows import TextRows
from kit.world.problems import WorldError

ROWS_AROUND: Final = 3
"""Rows of the heading, the remark and the keys."""
KEPT: Final = (
    ("what is kept", "an answer, when you go on, back or leave"),
    ("blank", "counts only as blank; Enter without an answer"),
    ("who sees it", "your teacher, if you hand in your progress"),
)
_REMARK: Final = row(("  Kept as you go on. Only you see it until you hand it in.", "dim"))


class FormScreen(ActivePaintScreen[None]):
    """Asks what a session has ahead. Draws nothing but what a key has changed."""

    AUTO_FOCUS = ""
    screen_actions = ScreenActions(
        "form",
        ("form_answer", "type_answer", "next", "choose", "previous", "clear_answer", "help", "back"),
        own=(
            ScreenAction("form_answer", "1 to 7", "answer", "choose an answer; Enter keeps it", digits("answer", 1, 7), "1-7"),
            letter("type_answer", "e", "type", "type your answer; Esc ends typing, Enter keeps it"),
            letter("clear_answer", "x", "clear", "clear the answer, so that Enter leaves it blank"),
        ),
    )  # fmt: skip
    BINDINGS: ClassVar[list[BindingType]] = bindings(screen_actions)
    DEFAULT_CSS = """
    FormScreen { layout: vertical; }
    FormScreen #heading, FormScreen #remark, FormScreen #keys { height: 1; }
    FormScreen #body, FormScreen #below { height: 1fr; }
    FormScreen #below, FormScreen AnswerField { display: none; }
    """

    def __init__(self, session: FormSession) -> None:
        super().__init__()
        self._session = session
        self._chosen: int | None = None
        """Index of the chosen answer; None: blank."""
        self._has_asked = session.question is not None
        self._field = AnswerField()

    def compose(self) -> ComposeResult:
        yield TextRows(id="heading")
        yield TextRows(id="body")
        yield self._field
        yield TextRows(id="below")
        yield TextRows(id="remark")
        yield TextRows(id="keys")

    def on_mount(self) -> None:
        self._ask(types=True)

    def on_resize(self, event: events.Resize) -> None:
        self.call_after_refresh(self._show)

    # What is shown

    def _ask(self, *, types: bool) -> None:
        """Shows the current question with its answer so far. ``types``: whether keys are for a text that is still empty."""
        question, value = self._session.question, self._session.value
        self._has_asked = self._has_asked or question is not None
        self._chosen = None
        if question is not None and value in question.values:
            self._chosen = question.values.index(value)
        self._field.display = self._rows("below").display = self._is_text
        if self._is_text:
            self._field.load_text(str(value or ""))
            self._field.move_cursor(self._field.document.end)
        self.set_focus(self._field if types and self._is_text and value is None else None)
        self._show()

    @property
    def _is_text(self) -> bool:
        """Whether the answer is typed."""
        return self._session.question is not None and self._session.question.shape is AnswerShape.TEXT

    def _show(self, remark: Row = ()) -> None:
        if not self.size.width:
            return
        width = self.size.width
        room = max(1, self.size.height - ROWS_AROUND)
        body = self._body()
        body, _ = window(body, len(body), room)  # answers stand at the end
        body = centred(body, width, room)
        if self._is_text:
            left = left_column(width) + MARGIN
            self._field.styles.margin = (0, max(0, width - left - text_width(width, WIDEST_TEXT)), 0, left)
        self._rows("body").styles.height = len(body) if self._is_text else "1fr"
        self._rows("heading").show([self._heading()])
        self._rows("body").show(body)
        self._rows("remark").show([remark or (_REMARK if self._session.question is not None else row())])
        self._rows("keys").show([self._keys()])

    def _heading(self) -> Row:
        title = row((self._session.form.title, "bold"))
        if self._session.question is None:
            return title
        place = (
            f"{PHASE_LABELS[self._session.phase]}, question {self._session.number} of {self._session.count}"
        )
        return spread(title, row((place, "dim")), self.size.width)

    def _body(self) -> list[Row]:
        question = self._session.question
        if question is not None:
            return question_rows(question, self._chosen, self.size.width)
        text = self._session.closing_text if self._has_asked else self._session.answered_text
        lines = textwrap.wrap(text, text_width(self.size.width, WIDEST_TEXT))
        return [row(), *(row(" " * MARGIN + line) for line in lines)]

    def _keys(self) -> Row:
        question, is_typing = self._session.question, self.focused is self._field
        idle: set[str] = set()
        labels = {"next": "next" if self._answer() is not None else "leave blank"}
        if question is None:
            idle = {"form_answer", "choose", "type_answer", "next", "clear_answer"}
            labels = {"previous": "change answers"}
        elif is_typing:
            idle = {"form_answer", "choose", "type_answer", "previous", "clear_answer", "help"}
            labels["back"] = "stop typing"
        elif self._is_text:
            idle = {"form_answer", "choose"}
        else:
            idle = {"type_answer"}
        if self._session.number == 1:
            idle.add("previous")
        if self._answer() is None:
            idle.add("clear_answer")
        count = 0 if question is None else len(question.values)
        return footer(
            self.screen_actions,
            self.size.width,
            without=idle,
            labels=labels,
            keys={"form_answer": f"1-{count}", "next": "Enter"},
        )

    def _rows(self, name: str) -> TextRows:
        return self.query_one(f"#{name}", TextRows)

    # Answers

    def _answer(self) -> AnswerValue:
        """The answer that is chosen or typed; None: it is blank. What is typed may still be none."""
        question = self._session.question
        if question is None:
            return None
        if self._is_text:
            return self._field.answer or None
        return None if self._chosen is None else question.values[self._chosen]

    def _checked_answer(self) -> AnswerValue:
        """The same. Raises InvalidAnswer if what is typed is none."""
        question = self._session.question
        assert question is not None
        return parse_answer(question, self._field.answer) if self._is_text else self._answer()

    def _save_change(self) -> bool:
        """Keeps what was changed at the current question, before it is left other than to go on. False: it cannot be kept, which
        is said."""
        question = self._session.question
        if question is None or self._answer() == self._session.value:
            return True
        try:
            self._session.save(self._checked_answer())
        except (InvalidAnswer, ProgressError) as error:
            self._show(row((f"  Not saved: {error}", "bad")))
            return False
        return True

    # Keys

    def action_answer(self, number: int) -> None:
        question = self._session.question
        if question is not None and number <= len(question.values):
            self._chosen = number - 1
            self._show()

    def action_choose(self, columns: int, rows: int) -> None:
        question = self._session.question
        if question is None or not question.values:
            return
        last = len(question.values) - 1
        step = columns + rows
        start = (-1 if step > 0 else last + 1) if self._chosen is None else self._chosen
        self._chosen = min(max(start + step, 0), last)
        self._show()

    def action_clear_answer(self) -> None:
        self._chosen = None
        self._field.load_text("")
        self._show()

    def action_type_answer(self) -> None:
        if self._is_text:
            self.set_focus(self._field)
            self._show()

    def action_next(self) -> None:
        if self._session.question is None:
            return
        try:
            self._session.answer(self._checked_answer())
        except (InvalidAnswer, ProgressError) as error:
            self._show(row((f"  Not saved: {error}", "bad")))
            return
        self._ask(types=True)

    def action_previous(self) -> None:
        if self._save_change() and self._session.go_back():
            self._ask(types=False)

    def action_help(self) -> None:
        self.app.push_screen(HelpDialog("The form", self.screen_actions, KEPT))

    def action_back(self) -> None:
        if not self._save_change():
            return
        if len(self.app.screen_stack) > 2:
            self.dismiss()
        else:
            self.app.exit()

    # The field

    def on_answer_entered(self) -> None:
        self.action_next()

    def on_editor_left(self) -> None:
        self.set_focus(None)
        self._show()

    def on_text_area_changed(self) -> None:
        self._show()


async def ask_form(screen: Screen[Any], journal: ProgressJournal) -> None:
    """Asks the form where the student stopped, and comes back. To be called in a worker."""
    try:
        form = await to_thread(read_form)
        session = FormSession(form, current_phase(form, journal), journal)
    except (WorldError, FileNotFoundError, ProgressError) as error:
        screen.app.push_screen(MessageDialog("The form cannot be opened", wrapped(str(error))))
        return
    await screen.app.push_screen_wait(FormScreen(session))
