"""Dialogs over a screen: a text, the keys of a screen, and a field to type a name."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import ClassVar, Final

from textual import events
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.containers import Vertical
from textual.widgets import Input

from kit.dialogue.actions import ScreenActions
from kit.document.rows import Row, broken, row
from kit.tui.input.drive_keys import base_key
from kit.tui.input.driver import key_driver
from kit.tui.rows.key_rows import help_page
from kit.tui.screens.dialog import Dialog
from kit.tui.widgets.text_field import KitInput
from kit.tui.widgets.text_rows import TextRows

WIDTH: Final = 74
BORDER_ROWS: Final = 2
BORDER_COLUMNS: Final = 4
"""With a blank on either side of the text."""
MODIFIERS: Final = ("left_shift", "right_shift", "left_control", "right_control")
SCROLL_ROWS: Final = {"up": -1, "down": 1, "pageup": -10, "pagedown": 10}


MOUSE_NOTES: Final = {
    True: (
        (
            "mouse",
            (
                "clicks press keys and choose; on a floor they drive there; the wheel zooms and chooses. "
                "Most terminals select text with Shift"
            ),
        ),
        ("Ctrl-P Mouse", "leaves it to the terminal"),
    ),
    False: (
        ("mouse", "left to the terminal, so that text can be selected"),
        ("Ctrl-P Mouse", "gives it to the kit: clicks press keys, choose, drive"),
        ("KIT_MOUSE=1 kit", "begins with that"),
    ),
}
"""What the mouse does, on every help page: where the kit has it, and where not."""


class MessageDialog(Dialog[None]):
    """Shows a text, or rows; where they are more than the terminal holds, the arrow keys scroll them."""

    DEFAULT_CSS = f"""
    MessageDialog > Vertical {{ width: {WIDTH}; max-width: 100%; height: auto; max-height: 100%; border: solid $foreground; padding: 0 1; }}
    MessageDialog TextRows {{ height: auto; }}
    """
    CLOSES: Final = "any key closes"

    def __init__(self, title: str, told: str | Sequence[Row], *, passes_keys: bool = False) -> None:
        """``passes_keys``: the key that closes it, unless that is Esc, is also for the screen below: nothing was asked."""
        super().__init__()
        self._title, self._passes_keys = title, passes_keys
        self._shown_rows = tuple(map(row, told.splitlines())) if isinstance(told, str) else tuple(told)
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
        return max(0, len(self._broken_rows) + BORDER_ROWS - self.size.height)

    @property
    def _broken_rows(self) -> list[Row]:
        """The rows in the width of the box: a longer one goes on below."""
        width = max(1, min(WIDTH, self.size.width) - BORDER_COLUMNS)
        return [each for parts in self._shown_rows for each in broken(parts, width)]

    def _show(self) -> None:
        if not self.query(TextRows):  # before they are mounted, or while the kit is left
            return
        self._top = max(0, min(self._top, self._overflow))
        self.query_one(TextRows).show(self._broken_rows[self._top :])
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
            if self._passes_keys and key != "escape":
                self.app.post_message(events.Key(event.key, event.character))
            self.dismiss()

    def on_click(self, event: events.Click) -> None:
        if self.is_active:
            self.dismiss()

    def on_mouse_scroll_down(self, event: events.MouseScrollDown) -> None:
        event.stop()
        self._top += 1
        self._show()

    def on_mouse_scroll_up(self, event: events.MouseScrollUp) -> None:
        event.stop()
        self._top -= 1
        self._show()


class HelpDialog(MessageDialog):
    """All keys of a screen. ``notes``: blocks of signs or terms, and what they mean."""

    def __init__(
        self,
        title: str,
        screen: ScreenActions,
        *notes: Sequence[tuple[str, str]],
        without: Sequence[str] = (),
    ) -> None:
        super().__init__(title, ())
        self._page = partial(help_page, screen, without=without)
        self._notes = notes

    def compose(self) -> ComposeResult:
        driver = key_driver(self.app)
        tells_of_mouse = any(name == "mouse" for note in self._notes for name, _ in note)
        mouse = () if tells_of_mouse else (MOUSE_NOTES[driver is not None and driver.has_mouse],)
        self._shown_rows = self._page(*self._notes, *mouse)
        yield from super().compose()


class NameDialog(Dialog[str | None]):
    """Returns what was typed, or None if nothing was."""

    BINDINGS: ClassVar[list[BindingType]] = [("escape", "back", "")]
    DEFAULT_CSS = f"""
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
            yield KitInput(self._value, select_on_focus=False)

    def on_mount(self) -> None:
        field = self.query_one(Input)
        field.cursor_blink = False
        field.focus()

    def on_input_submitted(self, event: Input.Submitted) -> None:
        self.dismiss(event.value.strip() or None)

    def action_back(self) -> None:
        self.dismiss(None)
