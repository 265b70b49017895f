"""A screen of text alone, which scrolls."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar, Final

from textual import events
from textual.app import ComposeResult
from textual.binding import BindingType

from kit.dialogue.actions import ScreenActions
from kit.document.rows import Row, at_both_edges, broken, lines_shown, row, row_width, side_by_side
from kit.tui.rows.key_rows import bindings, footer
from kit.tui.textual_patches import ActivePaintScreen
from kit.tui.widgets.text_rows import TextRows

COLUMN: Final = 80
"""Columns of the left one of two texts beside each other, where there is room for two of them."""
COLUMNS_BETWEEN: Final = 2
LEAST_BESIDE: Final = 54
"""Columns without which nothing stands beside the rest."""


class TextScreen(ActivePaintScreen[None]):
    """Shows rows as they are; one that is too long goes on below."""

    AUTO_FOCUS = ""
    screen_actions = ScreenActions("text", ("scroll", "back"), ("close",))
    BINDINGS: ClassVar[list[BindingType]] = bindings(screen_actions)
    DEFAULT_CSS = """
    TextScreen { layout: vertical; }
    TextScreen #heading, TextScreen #keys { height: 1; }
    TextScreen #body { height: 1fr; }
    """

    def __init__(self, title: str, rows: Sequence[Row], beside: Sequence[Row] = ()) -> None:
        """``beside``: more rows, to the right of the others where there is room, else below them."""
        super().__init__()
        self._title = title
        self._rows = tuple(rows)
        self._beside = tuple(beside)
        self._shown: list[Row] = []
        """The same on as many rows as the width asks for."""
        self._width = 0
        self._top = 0
        self._scrolls = False
        """Whether there is more than the screen shows."""

    def compose(self) -> ComposeResult:
        yield TextRows(id="heading")
        yield TextRows(id="body")
        yield TextRows(id="keys")

    def on_resize(self, event: events.Resize) -> None:
        self.call_after_refresh(self._show)

    def _show(self) -> None:
        room = max(1, self.size.height - 2 - self._rows_below)
        if self.size.width != self._width:
            self._width = self.size.width
            together = self._arranged(self._width, room)
            self._shown = [each for parts in together for each in broken(parts, self._width)]
        self._scrolls = len(self._shown) > room
        self._top = max(0, min(self._top, len(self._shown) - room))
        last = min(len(self._shown), self._top + room)
        where = lines_shown(self._top, last - self._top, len(self._shown))
        heading = at_both_edges(row((self._title, "bold")), row((where, "dim")), self.size.width)
        self.query_one("#heading", TextRows).show([heading])
        self.query_one("#body", TextRows).show(self._shown[self._top : last])
        self.query_one("#keys", TextRows).show([self._keys()])

    def _arranged(self, width: int, height: int) -> list[Row]:
        """All rows in the order in which they stand; what is too wide is broken afterwards. ``height``: without scrolling."""
        column = self._column
        if not column:
            return [*self._rows, *self._beside]
        right = [each for parts in self._beside for each in broken(parts, width - column)]
        return side_by_side(self._rows, right, column)

    @property
    def _column(self) -> int:
        """The column of what stands beside the rest; 0 where there is no room, or nothing."""
        if not self._beside or self._width >= 2 * COLUMN:
            return COLUMN if self._beside else 0
        column = max(map(row_width, self._rows), default=0) + COLUMNS_BETWEEN
        return column if column + LEAST_BESIDE <= self._width else 0

    @property
    def _rows_below(self) -> int:
        """Rows between the text and the keys."""
        return 0

    def _keys(self) -> Row:
        return footer(self.screen_actions, self.size.width, without=self._unavailable_actions())

    def _unavailable_actions(self) -> list[str]:
        """Actions that do nothing now."""
        return [] if self._scrolls else ["scroll"]

    def action_scroll(self, lines: int) -> None:
        self._top += lines
        self._show()

    def action_back(self) -> None:
        self.dismiss()
