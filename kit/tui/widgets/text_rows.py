"""Rows of short texts that repaint only what changed: headings, read-outs, messages, keys."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Final

from rich.cells import cell_len
from rich.segment import Segment
from rich.style import Style
from textual import events
from textual.geometry import Region, Size
from textual.message import Message
from textual.strip import Strip
from textual.widget import Widget

from kit.document.rows import CUT, PLAIN, Row, row_width
from kit.tui.textual_patches import ActivePaintScreen, Result, crop_left

STYLES: Final = {
    PLAIN: Style(),
    "dim": Style(dim=True),
    "bold": Style(bold=True),
    "key": Style(color="cyan", reverse=True),
    "title": Style(color="cyan", bold=True),
    "press": Style(color="cyan", bold=True),
    "chosen": Style(color="cyan", reverse=True, bold=True),
    "code": Style(color="cyan", bold=True),
    "good": Style(color="green", bold=True),
    "warn": Style(color="yellow", bold=True),
    "bad": Style(color="red", bold=True),
    "bronze": Style(color="#a8652a"),
}
"""The few ways a text can look. Each bold, dim or reversed, so that none means anything by its colour alone; but bronze, which
is a medal's letter: of the 16 colours it becomes brown, which bold would make gold's yellow."""

ERROR: Final = "error"
SYNTAX_STYLES: Final[Mapping[str, Style]] = MappingProxyType(
    {
        "comment": Style(dim=True, italic=True),
        "keyword": Style(color="magenta", bold=True),
        "constant": Style(color="cyan"),
        "string": Style(color="green"),
        "number": Style(color="cyan"),
        "definition": Style(color="blue", bold=True),
        "decorator": Style(color="yellow"),
        ERROR: Style(color="red", underline=True, bold=True),
    }
)
"""In the names of the 16 colours, which a theme replaces by its own as it does in all texts."""

LOOKS: Final = MappingProxyType({**STYLES, **SYNTAX_STYLES})
"""Both, by their names."""

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
        "◀": "<",
        "▲": "^",
        "▼": "v",
        "●": "*",
        "…": "..",
        "·": ".",
        "█": "#",
        "▒": "x",
        "░": ".",
        "■": "#",
        "□": "x",
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
    "^P": "ctrl+p",
    "^S": "ctrl+s",
}
"""What is printed for a key, and Textual's name of it. A letter or digit is its own name."""

LONGEST_GAP: Final = 12
"""Columns between two changes that are painted with them: to move the cursor and set the style again takes as many bytes."""


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
        return [(0, max(row_width(old), row_width(new)))]
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


class RowClicked(Message):
    """A row that names no key was clicked."""

    def __init__(self, rows: TextRows, number: int, column: int) -> None:
        super().__init__()
        self.rows = rows
        self.number = number
        """From 0."""
        self.column = column


class TextRows(Widget):
    """Shows as many rows as it has lines; the rest is cut off. Where the mouse is read, a click on a key presses it."""

    can_focus = False

    def __init__(self, *, id: str | None = None, opens: bool = True) -> None:  # noqa: A002 - Textual's own name
        """``opens``: whether a click on what is drawn as chosen presses Enter."""
        super().__init__(id=id)
        self._opens = opens
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
        if key and (self._opens or key != "enter"):
            event.stop()
            self.app.post_message(events.Key(key, key if len(key) == 1 else None))
        else:
            self.post_message(RowClicked(self, event.y, event.x))

    def get_content_width(self, container: Size, viewport: Size) -> int:
        return max(map(row_width, self._rows), default=0)

    def get_content_height(self, container: Size, viewport: Size, width: int) -> int:
        return len(self._rows)

    def render_line(self, y: int) -> Strip:
        parts = self._rows[y] if y < len(self._rows) else ()
        if self.app.has_class(ASCII_ONLY):
            parts = tuple((".." if text == CUT else text.translate(_ASCII), style) for text, style in parts)
        # In the terminal's own colours a style says nothing of the background, which costs no bytes.
        paper = STYLES[PLAIN] if self.app.native_ansi_color else self.rich_style
        strip = Strip([Segment(text, paper + LOOKS[style]) for text, style in parts if text])
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
