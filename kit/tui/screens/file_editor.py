"""The kit's own editor in place of the whole screen; and which editor a file is opened in from a screen."""

from __future__ import annotations

import os
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any, ClassVar, Final

from textual.app import App, ComposeResult
from textual.binding import BindingType
from textual.containers import Horizontal
from textual.screen import ModalScreen

from kit.dialogue.actions import ScreenActions
from kit.document.rows import MARGIN, Row
from kit.host.failure import syntax_error
from kit.school.lessons.aside import has_easy_editor
from kit.tui.rows.key_rows import bindings, key_row
from kit.tui.screens.dialogs import MessageDialog
from kit.tui.suspend import edit_aside
from kit.tui.terminal import TerminalDecision
from kit.tui.widgets.program_editor import ProgramEditor, ProgramFile, ProgramFileError
from kit.tui.widgets.text_rows import TextRows

Beside = Callable[[int, int, str], list[Row]]
"""Makes rows of at most so many columns, so many at most, with glyphs of this kind."""
PROGRAM_COLUMNS: Final = (84, 108)
"""At least and at most so many for a program's lines with their numbers, where something stands beside them."""
LEAST_BESIDE, MOST_BESIDE = 30, 90
"""Columns of what does, with which the program's become more."""


class FileEditorScreen(ModalScreen[None]):
    """Edits one file; what is not saved when it is left is kept beside it."""

    screen_actions = ScreenActions("file editor", ("save_program", "editor"))
    BINDINGS: ClassVar[list[BindingType]] = bindings(screen_actions)
    DEFAULT_CSS = """
    FileEditorScreen ProgramEditor { width: 1fr; max-width: 100%; height: 1fr; }
    FileEditorScreen #beside { width: auto; height: 1fr; margin: 1 0 0 2; }
    FileEditorScreen #keys { dock: bottom; height: 1; }
    """

    def __init__(
        self, program: ProgramFile, line: int, problem: str, beside: Beside | None = None, glyphs: str = ""
    ) -> None:
        """``line``: where the cursor is put, from 1. ``problem``: what is wrong there; empty: nothing. ``beside``: what stands
        beside the text where there is room, drawn with ``glyphs``."""
        super().__init__()
        self._editor = ProgramEditor(program)
        self._line, self._problem = line, problem
        self._beside, self._glyphs = beside, glyphs

    def compose(self) -> ComposeResult:
        with Horizontal():
            yield self._editor
            yield TextRows(id="beside")
        yield TextRows(id="keys")

    def on_resize(self) -> None:
        program = max(PROGRAM_COLUMNS[0], min(PROGRAM_COLUMNS[1], self.size.width - MOST_BESIDE))
        columns = self.size.width - program - MARGIN
        has_room = self._beside is not None and columns >= LEAST_BESIDE
        rows = self._beside(columns, self.size.height - 3, self._glyphs) if self._beside and has_room else []
        shown = self.query_one("#beside", TextRows)
        shown.display, shown.styles.width = bool(rows), columns
        shown.show(rows)

    def on_mount(self) -> None:
        self.query_one("#keys", TextRows).show(
            [key_row(("^S", "save"), ("Esc", "close"), ("^Z", "undo"), ("^Y", "redo"), ("^P", "find"))]
        )
        self.call_after_refresh(self._begin)

    def _begin(self) -> None:
        self._editor.area.focus()
        self._editor.go_to_line(self._line)
        if self._problem:
            self._editor.show_problem(self._line, self._problem)

    def action_save_program(self) -> None:
        """Nothing runs here that would tell of a text that is no Python."""
        self._editor.save()
        if self._editor.is_saved and self._editor.program.file.suffix == ".py":
            error = syntax_error(self._editor.area.text)
            self._editor.show_problem(error.lineno if error else None, error.msg if error else "")

    def action_editor(self) -> None:
        self._editor.keep_draft()
        self.dismiss()

    def on_editor_left(self) -> None:
        self.action_editor()


class EditsFile:
    """A screen that opens one file: with ``e`` in the student's editor, with ``^E`` in the kit's."""

    def action_edit_file(self) -> None:
        self.edit(is_here=False)

    def action_editor(self) -> None:
        self.edit(is_here=True)

    def edit(self, *, is_here: bool) -> None:
        """Opens it. ``is_here``: as of ``edit_file``."""
        raise NotImplementedError


def edit_file(
    app: App[Any],
    file: Path,
    terminal: TerminalDecision,
    edited: Callable[[], None],
    *,
    line: int = 1,
    problem: str = "",
    is_here: bool = False,
    beside: Beside | None = None,
) -> None:
    """Opens a file in the editor that is named or shows its own keys, else in the kit's; ``edited`` is called at its end where
    the file is another one then. ``line``, ``problem``, ``beside``: as of ``FileEditorScreen``. ``is_here``: in the kit's in any case."""
    before = _content(file)

    def look(_: None = None) -> None:
        if _content(file) != before:
            edited()

    if not is_here and has_easy_editor(os.environ):
        if said := edit_aside(app, file, line, terminal):
            app.push_screen(MessageDialog("No editor opened", said))
        look()
        return
    try:
        app.push_screen(
            FileEditorScreen(ProgramFile(file), line, problem, beside, terminal.glyphs.value), look
        )
    except ProgramFileError as error:
        app.push_screen(MessageDialog("This file cannot be edited here", str(error)))


def _content(file: Path) -> bytes:
    """Empty where it cannot be read."""
    with suppress(OSError):
        return file.read_bytes()
    return b""
