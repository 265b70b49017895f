"""One page of text over the screen, such as all keys or what went wrong; any key leaves it."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from typing import Final

from textual import events
from textual.app import ComposeResult
from textual.containers import Vertical
from textual.screen import ModalScreen

from kit.tui.input.keys import base_key
from kit.tui.widgets.text_rows import Row, TextRows, row

WIDTH: Final = 74


def wrapped(text: str, style: str = "") -> list[Row]:
    """The text's lines as rows of a page, the long ones on several."""
    return [
        row((part, style))
        for line in text.splitlines()
        for part in textwrap.wrap(line, WIDTH - 4, subsequent_indent="    ") or [""]
    ]


class MessageDialog(ModalScreen[None]):
    DEFAULT_CSS = f"""
    MessageDialog {{ align: center middle; }}
    MessageDialog > Vertical {{ width: {WIDTH}; max-width: 100%; height: auto; max-height: 100%; border: solid $foreground; padding: 0 1; }}
    MessageDialog TextRows {{ height: auto; }}
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
        event.stop()
        # Of two keys that come at once, the first has closed it already.
        if self.is_active and base_key(event.key) not in (
            "left_shift",
            "right_shift",
            "left_control",
            "right_control",
        ):
            self.dismiss()
