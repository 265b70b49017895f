"""An editor for a program or a file of answers, beside what it is for: in colours, saved on Ctrl-S, errors at their line."""

from __future__ import annotations

import fcntl
import os
import stat
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from types import MappingProxyType
from typing import ClassVar, Final
from weakref import finalize

from rich.cells import cell_len
from textual import events
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.geometry import Offset
from textual.message import Message
from textual.timer import Timer
from textual.widgets import TextArea

from kit.controllers import ControllerFile, find_controller, kit_controllers
from kit.document.rows import Row, row, row_text
from kit.host.failure import Failure
from kit.plain_text import wrap
from kit.school.lessons.shell_lines import shell_path
from kit.tui.rows.key_rows import key_row
from kit.tui.widgets.program_colours import LANGUAGES, coloured_spans
from kit.tui.widgets.text_field import KitTextArea
from kit.tui.widgets.text_rows import ERROR, SYNTAX_STYLES, TextRows
from kit.workspace import write_atomically

INDENTS: Final = MappingProxyType({"python": 4, "yaml": 2})
"""Columns of one level of indentation, by language."""
DRAFT_SUFFIX: Final = ".unsaved"
"""Ending of the file beside the program that keeps what was typed and not saved when the screen was left."""
MAX_BYTES: Final = 1_000_000
"""A file larger than this is no program that anybody types."""
DRAFT_INTERVAL_S: Final = 1.0
"""What has been typed is on the disk after so long, saved or not [s]."""
STATE_ROWS: Final = 4
"""Most rows below the text: what was done with the file, and what is wrong with it."""


class ProgramFileError(Exception):
    """The file cannot be edited here; the message says why and what to do instead."""


class ProgramFile:
    """The file of one program. Raises ProgramFileError when opened, if it cannot be read as text or another editor of the
    kit's, whose draft it would be, has opened it."""

    def __init__(self, file: Path) -> None:
        self.file: Final = file
        self._unlock: Callable[[], object] = lambda: None
        self._locked: os.stat_result | None = None
        self._lock()
        self.draft: str | None = None
        """What was typed the last time and never saved; None where there is nothing of the kind."""
        self.is_draft_older = False
        """Whether somebody has saved the file after the draft was typed."""
        self.reread()

    def reread(self) -> None:
        """Reads the file and its draft again. Raises ProgramFileError."""
        self._known = self._read()
        self.draft = self._read_draft()
        self.is_draft_older = self.draft is not None and self._was_saved_after_draft()

    def close(self) -> None:
        """Lets other editors open it."""
        self._unlock()
        self._locked = None

    def _lock(self) -> None:
        """Keeps other editors of the kit's out of the file that lies there now: who saves it puts another one in its place. A
        file system without locks keeps nobody out. Raises ProgramFileError if another editor has it."""
        try:
            opened = os.open(self.file, os.O_RDONLY)
        except OSError:  # reading it says why
            return
        if self._locked is not None and os.path.samestat(self._locked, os.fstat(opened)):
            os.close(opened)
            return
        try:
            fcntl.flock(opened, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            os.close(opened)
            text = f"{self.file} is open in another editor of the kit, which keeps what is typed. Go on there, or close it first."
            raise ProgramFileError(text) from None
        except OSError:
            pass
        self._unlock()
        self._unlock, self._locked = finalize(self, os.close, opened), os.fstat(opened)

    @property
    def text(self) -> str:
        """Text as last read or saved."""
        return self._known

    @property
    def draft_file(self) -> Path:
        """The file in which a draft is kept."""
        return self.file.with_name(f".{self.file.name}{DRAFT_SUFFIX}")

    def newer_text(self) -> str | None:
        """The text that another program has saved since; None if none has."""
        with suppress(ProgramFileError):
            if (found := self._read()) != self._known:
                return found
        return None

    def accept(self, text: str) -> None:
        """Takes what somebody else has saved as known."""
        self._known = text
        with suppress(ProgramFileError):  # it has been opened elsewhere too, since
            self._lock()

    def save(self, text: str) -> None:
        """Writes the file at once or not at all. Raises ProgramFileError."""
        try:
            if self.file.exists() and not self.file.stat().st_mode & (
                stat.S_IWUSR | stat.S_IWGRP | stat.S_IWOTH
            ):
                raise ProgramFileError(
                    f"{self.file.name} is read-only: `chmod u+w {shell_path(self.file)}` lets you save it."
                )
            write_atomically(self.file, text.encode())
        except OSError as error:
            raise ProgramFileError(f"{self.file} could not be saved: {error.strerror}.") from error
        self._known = text
        self.drop_draft()
        with suppress(ProgramFileError):
            self._lock()

    def keep_draft(self, text: str) -> str:
        """Keeps what is not saved beside the file, for the next time. Returns why that was not possible; empty if it was."""
        try:
            if text != self._known:
                write_atomically(self.draft_file, text.encode())
            else:
                self.draft_file.unlink(missing_ok=True)
        except OSError as error:
            return f"not on the disk: {error.strerror}"
        return ""

    def drop_draft(self) -> None:
        """Forgets the draft."""
        self.draft, self.is_draft_older = None, False
        with suppress(OSError):
            self.draft_file.unlink(missing_ok=True)

    def _was_saved_after_draft(self) -> bool:
        try:
            return self.file.stat().st_mtime_ns > self.draft_file.stat().st_mtime_ns
        except OSError:
            return False

    def _read_draft(self) -> str | None:
        try:
            found = self.draft_file.read_bytes().decode()
        except (OSError, UnicodeDecodeError):
            return None
        return None if found == self._known else found

    def _read(self) -> str:
        try:
            if self.file.stat().st_size > MAX_BYTES:
                raise ProgramFileError(
                    f"{self.file} is larger than {MAX_BYTES // 1_000_000} MB. Open it with another editor."
                )
            return self.file.read_bytes().decode()
        except OSError as error:
            raise ProgramFileError(f"{self.file} cannot be read: {error.strerror}.") from error
        except UnicodeDecodeError as error:
            text = f"{self.file} is not text in UTF-8 (byte {error.start}). Save it as UTF-8 with another editor first."
            raise ProgramFileError(text) from error


def editable_controller(controller: ControllerFile, folder: Path, generated: Path) -> ControllerFile:
    """The controller itself where its file is the user's, else a copy in the user's ``folder``, ``my_NAME.py``.

    A copy that exists is used as it is. ``generated``: the folder of runs, whose nodes are written again each time.
    Raises ProgramFileError.
    """
    kits = {each.file for each in kit_controllers()}
    if controller.file not in kits and generated not in controller.file.parents:
        return controller
    copy = folder / f"my_{controller.name}.py"
    try:
        if not copy.exists():
            folder.mkdir(parents=True, exist_ok=True)
            write_atomically(copy, controller.file.read_bytes())
    except OSError as error:
        text = f"{controller.name} is not your own, and could not be copied to {copy}: {error.strerror}."
        raise ProgramFileError(text) from error
    return find_controller(str(copy))


class ProgramSaved(Message):
    """The program has been saved."""


class PasteRefused(Message):
    """What was pasted is more than a program may be."""


CURSOR_ROOM: Final = 3
"""Columns that Textual keeps in sight from the cursor on."""


class ProgramTextArea(KitTextArea):
    """A text area with Python or YAML in colours. They come from pygments, which Textual brings along, so that nothing needs
    to be compiled; Textual's own way is the parser tree-sitter."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("ctrl+e", "screen.editor", show=False),
        Binding("ctrl+s", "screen.save_program", show=False),
    ]

    def __init__(self) -> None:
        self._failed_line: int | None = None
        self._coloured_as: str | None = None
        super().__init__(
            tab_behavior="indent", show_line_numbers=True, soft_wrap=False, syntax_styles=SYNTAX_STYLES
        )

    def show_text(self, text: str, language: str | None) -> None:
        """Shows another program's text; nothing of the one before can be undone. ``language``: the one in which its words are
        coloured, as pygments calls it; None: none."""
        self._coloured_as, self._failed_line = language, None
        self.load_text(text)

    def take_text(self, text: str) -> None:
        """Shows another state of the same text, with the cursor where it was: one edit more, which can be undone."""
        if text == self.text:
            return
        place = self.cursor_location
        self.history.checkpoint()
        self.replace(text, self.document.start, self.document.end)
        self.history.checkpoint()
        self.move_cursor(place)

    async def on_key(self, event: events.Key) -> None:
        """Enter begins the next line below the first word of this one, or further right where it opens a block; Backspace
        before the first word goes back by as much."""
        start, end = sorted(self.selection)
        before = self.document.get_line(start[0])[: start[1]]
        indent = before[: len(before) - len(before.lstrip())]
        step = INDENTS.get(self._coloured_as or "", 0)
        if event.key == "enter":
            deeper = " " * step * before.rstrip().endswith(":")
            self._replace_via_keyboard(f"\n{indent}{deeper}", start, end)
        elif event.key == "backspace" and start == end and before and before.isspace() and step:
            kept = (len(before) - 1) // step * step
            self._replace_via_keyboard("", (start[0], kept), end)
        else:
            return
        event.prevent_default()
        event.stop()

    async def _on_paste(self, event: events.Paste) -> None:
        """Refuses what is too much; what is not, Textual has the text area take afterwards."""
        if len(self.text) + len(event.text) > MAX_BYTES:
            event.prevent_default()
            event.stop()
            self.post_message(PasteRefused())

    def scroll_cursor_visible(self, center: bool = False, animate: bool = False) -> Offset:
        """The lines' beginnings come back as soon as the cursor has room beside them: Textual leaves a text scrolled to the right
        after a long line, as far as the cursor can still be seen."""
        offset = super().scroll_cursor_visible(center, animate)
        line, column = self.cursor_location
        before = cell_len(self.document.get_line(line)[:column])
        if self.scroll_offset.x and before + CURSOR_ROOM + self.gutter_width <= self.size.width:
            self.scroll_to(x=0, animate=False, immediate=True)
        return offset

    def mark_line(self, number: int | None) -> None:
        """Marks a line, from 1, as the one that is wrong; None: none is."""
        if number != self._failed_line:
            self._failed_line = number
            self._build_highlight_map()
            self.refresh()
            if (
                number is not None
                and self.is_mounted
                and not 0 <= number - 1 - self.scroll_offset.y < self.size.height
            ):
                self.scroll_to(y=max(0, number - 1 - self.size.height // 2), animate=False)

    def _build_highlight_map(self) -> None:
        """Called by Textual after each change of the text: columns of a line, in bytes, and the name of their style."""
        super()._build_highlight_map()
        lines = self.document.lines
        starts, offset = [], 0
        for line in lines:
            starts.append(offset)
            offset += len(line) + 1
        text = "\n".join(lines)
        number = 0
        for first, last, style in coloured_spans(text, self._coloured_as):
            if style not in SYNTAX_STYLES:
                continue
            while number + 1 < len(starts) and starts[number + 1] <= first:
                number += 1
            while first < last and number < len(lines):
                end = min(last, starts[number] + len(lines[number]))
                self._highlight(number, first - starts[number], end - starts[number], str(style))
                first = starts[number] + len(lines[number]) + 1
                number += first < last
        if self._failed_line is not None and self._failed_line <= len(lines):
            row_number = self._failed_line - 1
            indent = len(lines[row_number]) - len(lines[row_number].lstrip())
            self._highlight(row_number, indent, len(lines[row_number]), ERROR)

    def _highlight(self, number: int, first: int, last: int, style: str) -> None:
        line = self.document.lines[number]
        in_bytes = [len(line[:column].encode()) for column in (first, last)]
        self._highlights[number].append((in_bytes[0], in_bytes[1], style))


class ProgramEditor(Vertical):
    """Edits one program; above it its name, below it what is wrong with it."""

    DEFAULT_CSS = """
    ProgramEditor { width: 60%; max-width: 100; padding: 0 0 0 1; }
    ProgramEditor TextArea { height: 1fr; border: none; padding: 0; background: transparent; scrollbar-size: 0 0;
        overflow: scroll scroll; }  /* a bar that goes as an undo shortens the text ends Textual */
    ProgramEditor TextArea:focus { border: none; }
    ProgramEditor TextRows { height: 1; }
    """

    def __init__(self, program: ProgramFile) -> None:
        super().__init__()
        self._program = program
        self._first_line = 1
        """Where the cursor was put last; asked for before the text is there."""
        self._notice: Row = ()
        self._failure: Row = ()
        """What is wrong with the program as it was last run."""
        self._may_overwrite = False
        self.area = ProgramTextArea()
        self._draft_timer: Timer | None = None

    @property
    def program(self) -> ProgramFile:
        return self._program

    @property
    def is_saved(self) -> bool:
        """Whether what is shown is what is on disk."""
        return self.area.text == self._program.text

    def compose(self) -> ComposeResult:
        yield TextRows(id="editor-name")
        yield self.area
        yield TextRows(id="editor-state")

    def on_mount(self) -> None:
        self._show_whole()
        self.go_to_line(self._first_line)

    def on_unmount(self) -> None:
        self.keep_draft()  # however the kit is left
        self._program.close()

    def open(self, file: Path) -> None:
        """Edits the program of a file; one that is open already is read again. What is not saved of another one before is kept
        beside its file. Raises ProgramFileError, and then edits the one before."""
        if file == self._program.file:
            self._program.reread()
            self._show_draft()
            return
        program = ProgramFile(file)
        self.keep_draft()
        self._program.close()
        self._program = program
        self._show_whole()

    def _show_whole(self) -> None:
        self.area.show_text(self._program.text, LANGUAGES.get(self._program.file.suffix))
        self._show_draft()

    def _show_draft(self) -> None:
        """Shows the draft of the last time, if there is one, and says so."""
        program = self._program
        self._may_overwrite, self._failure = False, ()
        self.area.take_text(program.text if program.draft is None else program.draft)
        left = "as you left it, not saved"
        if program.draft is None:
            self._notice = ()
        elif program.is_draft_older:
            self._notice = row((f"{left}; the file was saved since: ^S twice overwrites it", "warn"))
        else:
            self._notice = row((f"{left}: ^S saves it", "warn"))
        self._show()

    def keep_draft(self) -> str:
        """Keeps what is not saved. Returns why that was not possible; empty if it was."""
        if self._draft_timer is not None:
            self._draft_timer.stop()
            self._draft_timer = None
        return self._program.keep_draft(self.area.text)

    def _keep_draft_and_say(self) -> None:
        if problem := self.keep_draft():
            self._notice = row((problem, "bad"))
            self._show()

    def save(self) -> None:
        """Saves; if somebody else has saved the file meanwhile, only when asked twice."""
        is_newer = self._program.is_draft_older or self._program.newer_text() is not None
        if is_newer and not self._may_overwrite:
            self._may_overwrite = True
            self._notice = row(("changed elsewhere meanwhile: ^S again overwrites that", "warn"))
            self._show()
            return
        self._may_overwrite = False
        try:
            self._program.save(self.area.text)
            self._notice = row(("saved", "good"))
            self.post_message(ProgramSaved())
        except ProgramFileError as error:
            self._notice = row((str(error), "bad"))
        self._show()

    def follow_file(self) -> None:
        """Shows what somebody else has saved, unless something here is not saved."""
        text = self._program.newer_text()
        if text is None:
            return
        if not self.is_saved:
            if not self._may_overwrite:  # else it has been asked already
                self._notice = row(("changed elsewhere meanwhile: ^S twice overwrites that", "warn"))
                self._show()
        else:
            self._program.accept(text)
            self.area.take_text(text)
            self._notice = row(("read again: it was saved elsewhere", "dim"))
            self._show()

    def show_failure(self, failure: Failure | None) -> None:
        """Marks the line where the program has failed, and says why below."""
        is_here = failure is not None and failure.file == self._program.file.name
        self.show_problem(
            failure.line if is_here and failure is not None else None,
            "" if failure is None else failure.message,
        )

    def show_problem(self, line: int | None, message: str) -> None:
        """Marks a line, from 1, as the one that is wrong, and says what is. An empty message: nothing is."""
        self.area.mark_line(line if self.is_saved else None)
        place = f"line {line}: " if line else ""
        self._failure = row((f"{place}{message}".partition("\n")[0], "bad")) if message else ()
        self._show()

    def go_to_line(self, number: int) -> None:
        """Puts the cursor at a line, from 1, and brings it into sight."""
        self._first_line = number
        lines = self.area.document.lines
        index = min(number, len(lines)) - 1
        # What is to be answered is written behind the colon.
        self.area.move_cursor((index, len(lines[index]) if lines[index].rstrip().endswith(":") else 0))
        self.area.scroll_cursor_visible(center=True, animate=False)

    def say(self, text: str) -> None:
        """Says something below the text, until something else is to be said."""
        self._notice = row((text, "dim"))
        self._show()

    def on_paste_refused(self) -> None:
        self._notice = row((f"not pasted: a program has at most {MAX_BYTES // 1_000_000} MB", "bad"))
        self._show()

    def on_text_area_changed(self, event: TextArea.Changed) -> None:
        if not self.is_saved and not self._may_overwrite and self._program.draft is None:
            self._notice = ()
        if self._draft_timer is None and not self.is_saved:
            self._draft_timer = self.set_timer(DRAFT_INTERVAL_S, self._keep_draft_and_say)
        self._show()

    def on_descendant_focus(self) -> None:
        self._show()

    def on_descendant_blur(self) -> None:
        self._show()

    def on_resize(self) -> None:
        self.call_after_refresh(self._show)

    def _show(self) -> None:
        if not self.is_mounted:
            return
        changed = "" if self.is_saved else "  not saved"
        name, state = self.query_one("#editor-name", TextRows), self.query_one("#editor-state", TextRows)
        name.show([row((self._program.file.name, "bold"), (changed, "warn"))])
        keys = row() if self.area.has_focus else key_row(("^E", "edit"))
        width = max(20, self.size.width - 1)
        failure = self._failure
        if failure and not self.is_saved:  # what is typed since may have mended it
            failure = row((f"as it was saved: {row_text(failure)}", "dim"))
        said = [
            row((line, each[-1][1]))
            for each in (self._notice, failure)
            if each
            for line in wrap(row_text(each), width)
        ]
        lines = said[:STATE_ROWS] or [keys]
        state.styles.height = len(lines)
        state.show(lines)
