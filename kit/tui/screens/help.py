"""Every key of a screen on one page; any key leaves it."""

from __future__ import annotations

from collections.abc import Sequence

from textual import events
from textual.app import ComposeResult
from textual.containers import Vertical
from textual.screen import ModalScreen

from kit.tui.input.keys import base_key
from kit.tui.text_rows import Row, TextRows


class Help(ModalScreen[None]):
    DEFAULT_CSS = """
    Help { align: center middle; }
    Help > Vertical { width: 74; max-width: 100%; height: auto; max-height: 100%; border: solid $foreground; padding: 0 1; }
    Help TextRows { height: auto; }
    """

    def __init__(self, title: str, rows: Sequence[Row]) -> None:
        super().__init__()
        self._title = title
        self._rows = rows

    def compose(self) -> ComposeResult:
        with Vertical() as box:
            box.border_title = self._title
            box.border_subtitle = "any key leaves"
            text = TextRows()
            text.show(self._rows)
            yield text

    def on_key(self, event: events.Key) -> None:
        if base_key(event.key) not in ("left_shift", "right_shift", "left_control", "right_control"):
            event.stop()
            self.dismiss()
