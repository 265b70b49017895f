"""A dialog with a text over the screen, such as all keys or an error message; any key closes it.

A dialog that asks for a name.

A long text over the whole screen, to be scrolled: a solution, what a program printed, a picture.
"""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from typing import ClassVar, Final

from textual import events
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.containers import Vertical
from textual.screen import ModalScreen
from textual.widgets import Input

from kit.tui.input.modes import base_key
from kit.tui.rows.key_rows import bindings, footer, help_page
from kit.tui.textual_patches import ActivePaintScreen
from kit.tui.widgets.text_rows import Row, TextRows, broken, row

WIDTH: Final = 74
BORDER_ROWS: Final = 2
MODIFIERS: Final = ("left_shift", "right_shift", "left_control", "right_control")
SCROLL_ROWS: Final = {"up": -1, "down": 1, "pageup": -10, "pagedown": 10}


MOUSE_NOTE: Final = (
    ("mouse", "left to the terminal, so that text can be selected"),
    ("KIT_MOUSE=1 kit", "clicks press keys, choose, drive; the wheel zooms"),
    ("", "with Shift most terminals select text all the same"),
)
"""What the mouse does, on every help page."""


def wrapped(text: str, style: str = "") -> list[Row]:
    """The lines of a text as rows of a dialog; long lines are wrapped."""
    return [
        row((part, style))
        for line in text.splitlines()
        for part in textwrap.wrap(line, WIDTH - 4, subsequent_indent="    ") or [""]
    ]


class MessageDialog(ModalScreen[None]):
    """Shows rows; where they are more than the terminal holds, the arrow keys scroll them."""

    DEFAULT_CSS = f"""
    MessageDialog {{ align: center middle; }}
    MessageDialog > Vertical {{ width: {WIDTH}; max-width: 100%; height: auto; max-height: 100%; border: solid $foreground; padding: 0 1; }}
    MessageDialog TextRows {{ height: auto; }}
    """
    CLOSES: Final = "any key closes"

    def __init__(self, title: str, rows: Sequence[Row]) -> None:
        super().__init__()
        self._title = title
        self._shown_rows = tuple(rows)
        self._top = 0

    def compose(self) -> ComposeResult:
        with Vertical() as box:
            box.border_title = self._title
            box.border_subtitle = self.CLOSES
            text = TextRows()
            text.show(self._shown_rows)
            yield text

    def on_resize(self, event: events.Resize) -> None:
        self._show()

    @property
    def _overflow(self) -> int:
        """Rows that do not fit."""
        return max(0, len(self._shown_rows) + BORDER_ROWS - self.size.height)

    def _show(self) -> None:
        if not self.query(TextRows):  # before they are mounted, or while the kit is left
            return
        self._top = max(0, min(self._top, self._overflow))
        self.query_one(TextRows).show(self._shown_rows[self._top :])
        more = "arrows scroll, " if self._overflow else ""
        self.query_one(Vertical).border_subtitle = more + self.CLOSES

    def on_key(self, event: events.Key) -> None:
        event.stop()
        key = base_key(event.key)
        if (
            not self.is_active
        ):  # of keys that come at once the first has closed it: the others are for the screen below
            self.app.post_message(events.Key(event.key, event.character))
        elif key in SCROLL_ROWS and self._overflow:
            self._top += SCROLL_ROWS[key]
            self._show()
        elif key not in MODIFIERS:
            self.dismiss()

    def on_click(self) -> None:
        if self.is_active:
            self.dismiss()

    def on_mouse_scroll_down(self) -> None:
        self._top += 1
        self._show()

    def on_mouse_scroll_up(self) -> None:
        self._top -= 1
        self._show()


class HelpDialog(MessageDialog):
    """All keys of a screen. ``notes``: blocks of signs or terms, and what they mean."""

    def __init__(
        self, title: str, screen: str, *notes: Sequence[tuple[str, str]], without: Sequence[str] = ()
    ) -> None:
        super().__init__(title, help_page(screen, *notes, MOUSE_NOTE, without=without))


class NameDialog(ModalScreen[str | None]):
    """Returns what was typed, or None if nothing was."""

    BINDINGS: ClassVar[list[BindingType]] = [("escape", "back", "")]
    DEFAULT_CSS = f"""
    NameDialog {{ align: center middle; }}
    NameDialog > Vertical {{ width: {WIDTH}; max-width: 100%; height: auto; border: solid $foreground; padding: 0 1; }}
    NameDialog Input, NameDialog Input:focus {{ border: none; padding: 0; height: 1; background: transparent; }}
    """

    def __init__(self, title: str, value: str = "") -> None:
        super().__init__()
        self._title = title
        self._value = value

    def compose(self) -> ComposeResult:
        with Vertical() as box:
            box.border_title = self._title
            box.border_subtitle = "Enter confirm, Esc back"
            yield Input(self._value, select_on_focus=False)

    def on_mount(self) -> None:
        field = self.query_one(Input)
        field.cursor_blink = False
        field.focus()

    def on_input_submitted(self, event: Input.Submitted) -> None:
        self.dismiss(event.value.strip() or None)

    def action_back(self) -> None:
        self.dismiss(None)


class TextScreen(ActivePaintScreen[None]):
    """Shows rows as they are; one that is too long goes on below."""

    AUTO_FOCUS = ""
    BINDINGS: ClassVar[list[BindingType]] = bindings("text")
    DEFAULT_CSS = """
    TextScreen { layout: vertical; }
    TextScreen #heading, TextScreen #keys { height: 1; }
    TextScreen #body { height: 1fr; }
    """

    def __init__(self, title: str, rows: Sequence[Row]) -> None:
        super().__init__()
        self._title = title
        self._rows = tuple(rows)
        self._shown: list[Row] = []
        """The same on as many rows as the width asks for."""
        self._width = 0
        self._top = 0

    def compose(self) -> ComposeResult:
        yield TextRows(id="heading")
        yield TextRows(id="body")
        yield TextRows(id="keys")

    def on_resize(self, event: events.Resize) -> None:
        self.call_after_refresh(self._show)

    def _show(self) -> None:
        room = max(1, self.size.height - 2)
        if self.size.width != self._width:
            self._width = self.size.width
            self._shown = [each for parts in self._rows for each in broken(parts, self._width)]
        self._top = max(0, min(self._top, len(self._shown) - room))
        last = min(len(self._shown), self._top + room)
        where = f"  lines {self._top + 1} to {last} of {len(self._shown)}" if len(self._shown) > room else ""
        self.query_one("#heading", TextRows).show([row((self._title, "bold"), (where, "dim"))])
        self.query_one("#body", TextRows).show(self._shown[self._top : last])
        self.query_one("#keys", TextRows).show([footer("text", self.size.width)])

    def action_scroll(self, lines: int) -> None:
        self._top += lines
        self._show()

    def action_back(self) -> None:
        self.dismiss()
