"""Rows of styled text, independent of what shows them: made, joined, cut and wrapped by terminal columns."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from itertools import zip_longest
from typing import Final

from rich.cells import cell_len

from kit.plain_text import line_end, wrap

MARGIN: Final = 2
"""Columns that are left free beside a text."""
TEXT_WIDTH: Final = 76
"""Columns of a text where nothing else is said: longer lines are hard to read, however wide the terminal."""
PLAIN: Final = ""
CUT: Final = "… "
"""Where a row is cut; a terminal that has no such sign shows two dots in the same two columns."""

StyledText = tuple[str, str]
"""A text and its tone."""

Row = tuple[StyledText, ...]


def row(*parts: str | StyledText) -> Row:
    """A row of texts; a bare string is plain."""
    return tuple((part, PLAIN) if isinstance(part, str) else part for part in parts)


def row_text(parts: Row) -> str:
    """The characters of a row, without blanks at its end."""
    return "".join(text for text, _ in parts).rstrip()


def at_both_edges(left: Row, right: Row, width: int) -> Row:
    """``left`` at the left edge and ``right`` at the right one; the left is cut where they meet, and says so.

    >>> row_text(at_both_edges(row("Lesson 3: ", ("Sensors", "bold")), row("2 of 5"), 22))
    'Lesson 3: Sen…  2 of 5'
    """
    room = width - row_width(right) - 1
    left = fitted(left, room)
    return (*left, (" " * (max(0, room - row_width(left)) + 1), PLAIN), *right)


def fitted(parts: Row, width: int) -> Row:
    """A row of at most ``width`` columns: a wider one is cut, and says so.

    >>> row_text(fitted(row("7 ", ("values of the state", "dim")), 16))
    '7 values of th…'
    """
    if row_width(parts) <= width:
        return parts
    has_sign = width > 2 * len(CUT)
    fitting = _beginning(parts, width - len(CUT) if has_sign else width)
    return (*fitting, (CUT, PLAIN)) if has_sign else fitting


def _beginning(parts: Row, width: int) -> Row:
    """As many characters of a row as have room."""
    width, made = max(0, width), []
    for text, style in parts:
        fitting = next(count for count in range(len(text), -1, -1) if cell_len(text[:count]) <= width)
        made += [(text[:fitting], style)] if fitting else []
        if fitting < len(text):
            break
        width -= cell_len(text)
    return tuple(made)


def row_width(parts: Row) -> int:
    """The columns that a row takes."""
    return sum(cell_len(text) for text, _ in parts)


def side_by_side(left: Sequence[Row], right: Sequence[Row], column: int) -> list[Row]:
    """Rows with others to their right, which begin at a column; a row of the left is cut there.

    >>> side_by_side([row("one"), row("two")], [row("three")], 6)
    [(('one', ''), ('   ', ''), ('three', '')), (('two', ''),)]
    """
    return [
        (*at_both_edges(here, (), column), *there) if there else here
        for here, there in zip_longest(left, right, fillvalue=())
    ]


def in_columns(
    sections: Callable[[int], Sequence[Sequence[Row]]], width: int, height: int, least: int, fewest: int = 1
) -> list[Row]:
    """Sections one after another in as few columns as it takes for ``height`` rows, none much longer than the others.

    ``sections``: the rows of each for a column's width; none is parted. ``least``: columns of the terminal that each has at least.
    ``fewest``: as many columns there are where there is room.

    >>> parts = [[row("a"), row("b")], [row("c")], [row("d")]]
    >>> [row_text(each) for each in in_columns(lambda columns: parts, 20, 2, 10)]
    ['a         c', 'b         d']
    """
    most = max(1, width // least)
    for count in range(min(fewest, most), most + 1):
        column = width // count
        made = sections(column)
        lengths = [len(each) for each in made]
        if count == most or sum(lengths) <= count * height:
            break
    longest = max(max(lengths, default=0), -(-sum(lengths) // count))
    while len(starts := _column_starts(lengths, longest)) > count:
        longest += 1
    joined: list[Row] = []
    for number, (first, last) in enumerate(zip(starts, [*starts[1:], len(made)], strict=True)):
        part = [
            broken_row for each in made[first:last] for parts in each for broken_row in broken(parts, column)
        ]
        joined = side_by_side(joined, part, number * column) if number else part
    return joined


def _column_starts(lengths: Sequence[int], longest: int) -> list[int]:
    """The number of the first section of each column that has at most ``longest`` rows."""
    starts, used = [0], 0
    for number, length in enumerate(lengths):
        if used + length > longest:
            starts.append(number)
            used = 0
        used += length
    return starts


def text_width(width: int, widest: int = TEXT_WIDTH) -> int:
    """Columns of a text of at most ``widest`` between the margins of a screen of ``width``."""
    return max(20, min(width - 2 * MARGIN, widest))


def entry_rows(
    mark: str, key: str, text: str, style: str, columns: int, *, is_open: bool = True
) -> list[Row]:
    """A text of ``columns`` with the key that chooses it, if it ``is_open``, and its mark in the margin; later lines begin below
    its first word."""
    first, *rest = wrap(text, columns - len(key) - 2)
    indent = " " * (MARGIN + len(key) + 2)
    return [
        row((f"{mark:>{MARGIN - 1}} ", style), (key, "press" if is_open else style), "  ", (first, style)),
        *(row((indent + line, style)) for line in rest),
    ]


def broken(parts: Row, width: int) -> list[Row]:
    """Wraps a row to rows of at most ``width`` columns, at blanks where it has them. What goes on begins below the row's text: that
    is what comes after the first two blanks beside each other, such as a key's meaning.

    >>> [row_text(each) for each in broken(row(" Esc  ", ("go back to the start", "bold")), 16)]
    [' Esc  go back to', '      the start']
    """
    width = max(2, width)  # some characters take two columns
    if row_width(parts) <= width:
        return [parts]
    hanging = _HANGING.match(row_text(parts))
    assert hanging is not None  # it matches the empty text
    indent = hanging.end() if 2 * hanging.end() <= width > 2 else 0
    made = []
    while row_width(parts) > width:
        fitting = len(row_text(_beginning(parts, width)))
        text = "".join(text for text, _ in parts)
        at = max(line_end(text, fitting, indent), indent + 1)
        made.append(_part(parts, 0, at))
        rest = at + len(text[at:]) - len(text[at:].lstrip())
        parts = (*row(*([" " * indent] if indent else [])), *_part(parts, rest, len(text)))
    return [*made, parts] if row_text(parts) else made


_HANGING: Final = re.compile(r" *(?:\S+(?: \S+)*  +(?=\S))?")
"""What stands before the text of a row: blanks, and a first word or words apart from the rest."""


def _part(parts: Row, start: int, stop: int) -> Row:
    """The characters of a row from ``start`` up to ``stop``."""
    made = []
    for text, style in parts:
        made.append((text[max(start, 0) : max(stop, 0)], style))
        start, stop = start - len(text), stop - len(text)
    return tuple(each for each in made if each[0])


def lines_shown(first: int, count: int, total: int) -> str:
    """Says which of ``total`` lines are shown, beginning with the number ``first``, from 0; empty where all are.

    >>> lines_shown(3, 10, 15), lines_shown(0, 15, 15)
    ('lines 4 to 13 of 15', '')
    """
    return f"lines {first + 1} to {first + count} of {total}" if count < total else ""


def window(rows: Sequence[Row], top: int, room: int) -> tuple[list[Row], int]:
    """The rows from ``top`` on that there is room for, with ``top`` lowered where they would end early, and that top; the last one
    says if there are more."""
    top = max(0, min(top, len(rows) - room))
    shown = list(rows[top : top + room])
    below = len(rows) - top - len(shown)
    if below > 0 and shown:
        shown[-1] = row((f"... {below + 1} more lines below: down", "dim"))
    return shown, top
