"""Screens of text alone, which scroll."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import ClassVar, Final

from textual import events
from textual.app import ComposeResult
from textual.binding import BindingType

from kit.dialogue.actions import ScreenActions
from kit.document.blocks import Block
from kit.document.layout import Page, sections_of
from kit.document.rows import MARGIN, Row, at_both_edges, broken, in_columns, lines_shown, row, text_width
from kit.tui.rows.key_rows import bindings, footer
from kit.tui.textual_patches import ActivePaintScreen
from kit.tui.widgets.text_rows import TextRows

LEAST_COLUMN: Final = 56
"""Columns without which no text stands beside another."""


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

    def __init__(self, title: str, rows: Sequence[Row]) -> None:
        super().__init__()
        self._title = title
        self._rows = tuple(rows)
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
        if len(self._shown) != room > 1:
            room -= 1  # an empty row above the keys, unless the text needs it
        self._scrolls = len(self._shown) > room
        self._top = max(0, min(self._top, len(self._shown) - room))
        last = min(len(self._shown), self._top + room)
        where = lines_shown(self._top, last - self._top, len(self._shown))
        heading = at_both_edges(row((self._title, "title")), row((where, "dim")), self.size.width)
        self.query_one("#heading", TextRows).show([heading])
        self.query_one("#body", TextRows).show(self._shown[self._top : last])
        self.query_one("#keys", TextRows).show([self._keys()])

    def _arranged(self, width: int, height: int) -> list[Row]:
        """All rows in the order in which they stand; what is too wide is broken afterwards. ``height``: without scrolling."""
        return [*self._rows]

    @property
    def _rows_below(self) -> int:
        """Rows between the text and the keys."""
        return 0

    def _keys(self) -> Row:
        return footer(self.screen_actions, self.size.width, without=self.unavailable_actions)

    @property
    def unavailable_actions(self) -> list[str]:
        """Actions that do nothing now."""
        return [] if self._scrolls else ["scroll"]

    def action_scroll(self, lines: int) -> None:
        self._top += lines
        self._show()

    def action_back(self) -> None:
        self.dismiss()


class SectionsScreen(TextScreen):
    """Shows sections of text, in columns where they take more rows than the screen has and there is room."""

    def __init__(
        self, title: str, sections: Callable[[int], Sequence[Sequence[Row]]], fewest: int = 1
    ) -> None:
        """As in ``in_columns``."""
        super().__init__(title, ())
        self._sections = sections
        self._fewest = fewest

    def _arranged(self, width: int, height: int) -> list[Row]:
        placed = in_columns(self._sections, width, height - 1, LEAST_COLUMN, self._fewest)
        return placed if len(placed) == height else [row(), *placed]


def page_screen(title: str, blocks: Sequence[Block], fewest: int = 1) -> SectionsScreen:
    """A screen with a text, in ``fewest`` columns or more where there is room."""
    return SectionsScreen(title, partial(_text_sections, blocks), fewest)


def _text_sections(blocks: Sequence[Block], columns: int) -> list[list[Row]]:
    return sections_of(blocks, Page(text_width(columns), MARGIN))
