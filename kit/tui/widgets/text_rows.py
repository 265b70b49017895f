"""Rows of short texts that repaint only what changed: headings, read-outs, messages, keys."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from itertools import zip_longest
from typing import Final

from rich.cells import cell_len, set_cell_size
from rich.segment import Segment
from rich.style import Style
from textual import events
from textual.geometry import Region, Size
from textual.message import Message
from textual.strip import Strip
from textual.widget import Widget

from kit.tui.textual_patches import ActivePaintScreen, Result, crop_left

MARGIN: Final = 2
"""Columns that are left free beside a text."""
TEXT_WIDTH: Final = 76
"""Columns of a text where nothing else is said: longer lines are hard to read, however wide the terminal."""
PLAIN: Final = ""
STYLES: Final = {
    PLAIN: Style(),
    "dim": Style(dim=True),
    "bold": Style(bold=True),
    "key": Style(reverse=True),
    "press": Style(bold=True),
    "chosen": Style(reverse=True, bold=True),
    "code": Style(color="cyan", bold=True),
    "good": Style(color="green", bold=True),
    "warn": Style(color="yellow", bold=True),
    "bad": Style(color="red", bold=True),
}
"""The few ways a text can look. Each bold or reversed, so that none means anything by its colour alone."""

ASCII_ONLY: Final = "-ascii"
"""The class of an app whose terminal has no other characters than ASCII's."""

_ASCII: Final = str.maketrans(
    {
        "←": "<",
        "→": ">",
        "↑": "^",
        "↓": "v",
        "°": "deg",
        "─": "-",
        "━": "=",
        "│": "|",
        "▶": ">",
        "●": "*",
        "…": "..",
        "·": ".",
        "█": "#",
        "▒": "x",
        "░": ".",
        **dict.fromkeys("┌┐└┘┬┴├┤┼", "+"),
        **dict.fromkeys("▁▂▃", "."),
        **dict.fromkeys("▄▅▆", ":"),
        "▇": "#",
        "▀": '"',
    }
)

SIGNS_OF_KEYS: Final = {
    "Enter": "enter",
    "Esc": "escape",
    "Tab": "tab",
    "Space": "space",
    "Del": "delete",
    "?": "question_mark",
    ".": "full_stop",
    ",": "comma",
    "/": "slash",
    "^C": "ctrl+c",
    "^E": "ctrl+e",
    "^S": "ctrl+s",
}
"""What is printed for a key, and Textual's name of it. A letter or digit is its own name."""

LONGEST_GAP: Final = 12
"""Columns between two changes that are painted with them: to move the cursor and set the style again takes as many bytes."""

StyledText = tuple[str, str]
"""A text and the name of its style."""

Row = tuple[StyledText, ...]


def row(*parts: str | StyledText) -> Row:
    """A row of texts; a bare string is plain."""
    return tuple((part, PLAIN) if isinstance(part, str) else part for part in parts)


def spread(left: Row, right: Row, width: int) -> Row:
    """``left`` at the left edge and ``right`` at the right one; the left is cut where they meet."""
    used = sum(cell_len(text) for text, _ in right)
    kept: list[StyledText] = []
    room = max(0, width - used - 1)
    for text, style in left:
        text = text if cell_len(text) <= room else set_cell_size(text, room)
        room -= cell_len(text)
        kept.append((text, style))
    return (*kept, (" " * (room + 1), PLAIN), *right)


def side_by_side(left: Sequence[Row], right: Sequence[Row], column: int) -> list[Row]:
    """Rows with others to their right, which begin at a column; a row of the left is cut there.

    >>> side_by_side([row("one"), row("two")], [row("three")], 6)
    [(('one', ''), ('   ', ''), ('three', '')), (('two', ''),)]
    """
    return [
        (*spread(here, (), column), *there) if there else here
        for here, there in zip_longest(left, right, fillvalue=())
    ]


def text_width(width: int, widest: int = TEXT_WIDTH) -> int:
    """Columns of a text of at most ``widest`` between the margins of a screen of ``width``."""
    return max(20, min(width - 2 * MARGIN, widest))


def entry_rows(mark: str, key: str, text: str, style: str, columns: int) -> list[Row]:
    """A text of ``columns`` with the key that chooses it, and its mark in the margin; later lines begin below its first word."""
    first, *rest = textwrap.wrap(text, columns - 3) or [""]
    indent = " " * (MARGIN + 3)
    return [
        row((f"{mark:>{MARGIN - 1}} ", style), (key, "press"), "  ", (first, style)),
        *(row((indent + line, style)) for line in rest),
    ]


def broken(parts: Row, width: int) -> list[Row]:
    """Wraps a row to rows of at most ``width`` columns.

    >>> broken(row("a long ", ("line", "bold")), 9)
    [(('a long ', ''), ('li', 'bold')), (('ne', 'bold'),)]
    """
    made: list[list[StyledText]] = [[]]
    room = width = max(2, width)  # some characters take two columns
    for text, style in parts:
        while cell_len(text) > room:
            fitting = next(count for count in range(room, -1, -1) if cell_len(text[:count]) <= room)
            made[-1] += [(text[:fitting], style)] if fitting else []
            made.append([])
            text, room = text[fitting:], width
        made[-1].append((text, style))
        room -= cell_len(text)
    return [tuple(each) for each in made]


def key_at(parts: Row, column: int) -> str:
    """Textual's name of the key that a click at this column of a row means; empty where it means none.

    That is the key, in the style ``press``, to whose text the column belongs; on a chosen row it is Enter.
    """
    key, start = "", 0
    for text, style in parts:
        if style == "press":
            sign = text.strip()
            is_itself = len(sign) == 1 and sign.isascii() and sign.isalnum()
            key = SIGNS_OF_KEYS.get(sign, sign if is_itself else "")
        elif style == "chosen":
            key = "enter"
        if start <= column < start + cell_len(text):
            return key
        start += cell_len(text)
    return ""


def changed_spans(old: Row, new: Row) -> list[tuple[int, int]]:
    """The columns, from and up to, in which two rows of the same length look different; all of them where the lengths differ
    or a character takes two columns.

    >>> changed_spans((("x  0.25 m", ""),), (("x  0.31 m", ""),))
    [(5, 7)]
    """
    before, after = _cells(old), _cells(new)
    if len(before) != len(after) or any(
        cell_len(char) != 1 for char, _ in (*before, *after) if char > "\xff"
    ):
        return [(0, max(_width(old), _width(new)))]
    spans: list[tuple[int, int]] = []
    for column, (was, now) in enumerate(zip(before, after, strict=True)):
        if was != now:
            if spans and column - spans[-1][1] <= LONGEST_GAP:
                spans[-1] = (spans[-1][0], column + 1)
            else:
                spans.append((column, column + 1))
    return spans


def _cells(parts: Row) -> list[tuple[str, str]]:
    return [(char, style) for text, style in parts for char in text]


def _width(parts: Row) -> int:
    return sum(cell_len(text) for text, _ in parts)


class RowClicked(Message):
    """A row that names no key was clicked."""

    def __init__(self, rows: TextRows, number: int, column: int) -> None:
        super().__init__()
        self.rows = rows
        self.number = number
        """From 0."""
        self.column = column


def window(rows: Sequence[Row], top: int, room: int) -> tuple[list[Row], int]:
    """As many rows as there is room for, from ``top`` on as far as there are so many, and that top; the last one
    says if there are more."""
    top = max(0, min(top, len(rows) - room))
    shown = list(rows[top : top + room])
    below = len(rows) - top - len(shown)
    if below > 0 and shown:
        shown[-1] = row((f"... {below + 1} more lines below: down", "dim"))
    return shown, top


class TextRows(Widget):
    """Shows as many rows as it has lines; the rest is cut off. Where the mouse is read, a click on a key presses it."""

    can_focus = False

    def __init__(self, *, id: str | None = None) -> None:  # noqa: A002 - Textual's own name
        super().__init__(id=id)
        self._rows: tuple[Row, ...] = ()

    def show(self, rows: Sequence[Row]) -> None:
        """Replaces the rows; only what differs is painted again."""
        new = tuple(rows)
        old, self._rows = self._rows, new
        width = max(1, self.size.width)
        is_ascii = self.app.has_class(ASCII_ONLY)  # which may put two characters in place of one
        for line in range(max(len(old), len(new))):
            if line >= len(old) or line >= len(new):
                self.refresh(Region(0, line, width, 1))
            elif old[line] != new[line]:
                spans = [(0, width)] if is_ascii else changed_spans(old[line], new[line])
                self.refresh(*(Region(start, line, stop - start, 1) for start, stop in spans))

    def show_all(self, rows: Sequence[Row]) -> None:
        """Replaces the rows, and takes as many lines as there are now."""
        if len(rows) != len(self._rows) or self.styles.height is None or not self.styles.height.is_cells:
            self.styles.height = len(rows)
        self.show(rows)

    def on_mount(self) -> None:
        crop_left(self.screen)

    def on_click(self, event: events.Click) -> None:
        if not 0 <= event.y < len(self._rows):
            return
        key = key_at(self._rows[event.y], event.x)
        if key:
            event.stop()
            self.app.post_message(events.Key(key, key if len(key) == 1 else None))
        else:
            self.post_message(RowClicked(self, event.y, event.x))

    def get_content_width(self, container: Size, viewport: Size) -> int:
        return max((sum(cell_len(text) for text, _ in parts) for parts in self._rows), default=0)

    def get_content_height(self, container: Size, viewport: Size, width: int) -> int:
        return len(self._rows)

    def render_line(self, y: int) -> Strip:
        parts = self._rows[y] if y < len(self._rows) else ()
        if self.app.has_class(ASCII_ONLY):
            parts = tuple((text.translate(_ASCII), style) for text, style in parts)
        # In the terminal's own colours a style says nothing of the background, which costs no bytes.
        paper = STYLES[PLAIN] if self.app.native_ansi_color else self.rich_style
        strip = Strip([Segment(text, paper + STYLES[style]) for text, style in parts if text])
        return strip.adjust_cell_length(self.size.width, paper)


class RowsScreen(ActivePaintScreen[Result]):
    """A screen of rows, and perhaps more, from which one goes back to the one below it."""

    def _rows(self, name: str) -> TextRows:
        return self.query_one(f"#{name}", TextRows)

    def action_back(self) -> None:
        """Returns to the screen that opened this one; ends the app where there is none."""
        if len(self.app.screen_stack) > 2:  # Textual's own lies at the bottom
            self.dismiss()
        else:
            self.app.exit()
