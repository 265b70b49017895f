"""A table in rows of a width: heads, a line below them, and the cells, whose words go on below where a column is narrow."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace
from typing import Final, NamedTuple

from kit.document.blocks import Cell, CellStyle, Column, Table, Tone, ToneText, format_cell
from kit.document.rows import Row, at_both_edges, lines_shown, row, row_text, row_width, side_by_side
from kit.plain_text import COLUMN_GAP, fit_widths, longest_part, printable_line, wrap

MIN_TEXT_WIDTH: Final = 8
"""Columns that a column of words keeps when room is short."""
SENTENCE_WIDTH: Final = 24
"""Columns in which sentences are still easy to read."""
MAX_CELL_LENGTH: Final = 600
BETWEEN_TABLES: Final = 4
"""Columns between the parts of a table that stand beside each other."""
LIST_MARGIN: Final = 3
"""Columns before the entries of a list: which one is chosen, and which are marked."""


class TableRows(NamedTuple):
    """A table without its title and note."""

    heads: tuple[Row, ...]
    entries: tuple[tuple[Row, ...], ...]
    """The rows of each of the table's."""


def table_rows(table: Table, width: int) -> TableRows:
    """Places a table in rows of at most ``width`` columns, as far as its numbers allow; optional columns are left out first."""
    table = drop_optional_columns(table, width)
    cells = [
        [_cell_text(cell, column) for cell, column in zip(each, table.columns, strict=True)]
        for each in table.rows
    ]
    heads = [column.title for column in table.columns]
    widths = _fitted_widths(table.columns, heads, cells, width)
    head = list(_placed_rows(heads, widths, table.columns, (Tone.DIM,) * len(heads))) if any(heads) else []
    if head and table.is_ruled:
        head.append(row((COLUMN_GAP.join("-" * each for each in widths), Tone.DIM)))
    if table.grouped and cells:
        _share_first_cells(table, cells, widths[0])
    label = Tone.PLAIN if any(heads) else Tone.BOLD  # names, and what is said of each
    entries = (
        tuple(_placed_rows(texts, widths, table.columns, _tones_of(told, label)))
        for texts, told in zip(cells, table.rows, strict=True)
    )
    return TableRows(tuple(head), tuple(entries))


def table_columns(table: Table, width: int, height: int) -> list[Row]:
    """A table of at most ``height`` rows where ``width`` allows that: its entries in as few columns as it takes, beside each
    other and each with the heads, groups undivided."""
    if not table.rows:
        return list(table_rows(table, width).heads)
    starts = [
        number for number in range(len(table.rows)) if not table.grouped or table.shows_first_cell(number)
    ]
    best = _rows_of_table(table, width)
    for count in range(2, len(starts) + 1):
        firsts = [starts[-(-len(starts) * part // count)] for part in range(count)]
        parts = [
            _rows_of_table(replace(table, rows=table.rows[first:last]), width)
            for first, last in zip(firsts, [*firsts[1:], len(table.rows)], strict=True)
        ]
        widths = [max(map(row_width, part)) + BETWEEN_TABLES for part in parts]
        if len(best) <= height or sum(widths) - BETWEEN_TABLES > width:
            break
        best = parts[-1]
        for part, columns in zip(parts[-2::-1], widths[-2::-1], strict=True):
            best = side_by_side(part, best, columns)
    return best


def _rows_of_table(table: Table, width: int) -> list[Row]:
    placed = table_rows(table, width)
    return [*placed.heads, *(each for entry in placed.entries for each in entry)]


def list_rows(table: Table, width: int, height: int, chosen: int, marked: Collection[int] = ()) -> list[Row]:
    """A table from which an entry is chosen: its heads, and as many entries as there is room for, the chosen one among them,
    whose name, the first cell with a word, stands out over the whole of its column.

    ``marked``: the numbers of entries with a mark of their own.
    """
    if table.rows:
        cells = list(table.rows[chosen])
        for number, column in enumerate(table.columns):
            text = format_cell(cells[number], column)
            if column.style is not CellStyle.NUMBER and any(map(str.isalpha, text)):
                longest = max(len(format_cell(each[number], column)) for each in table.rows)
                cells[number] = ToneText(text.ljust(longest), Tone.CHOSEN)
                break
        table = replace(table, rows=(*table.rows[:chosen], tuple(cells), *table.rows[chosen + 1 :]))
    placed = table_rows(replace(table, is_ruled=False), width - LIST_MARGIN)
    heads = [row((" " * LIST_MARGIN + row_text(each), Tone.DIM)) for each in placed.heads]
    made: list[Row] = []
    at = (0, 0)
    for number, entry in enumerate(placed.entries):
        if number == chosen:
            at = (len(made), len(entry))
        signs = row(
            (">" if number == chosen else " ", Tone.BOLD), ("*" if number in marked else " ", Tone.WARN), " "
        )
        made += [
            (*(signs if not level else row(" " * LIST_MARGIN)), *each) for level, each in enumerate(entry)
        ]
    room = max(1, height - len(heads))
    first_row = max(0, min(at[0] + at[1] // 2 - room // 2, len(made) - room))
    where = lines_shown(first_row, min(room, len(made)), len(made))
    if where and heads:
        if row_width(heads[-1]) + len(where) >= width:
            where = f"{first_row + 1}-{first_row + room}/{len(made)}"
        heads[-1] = at_both_edges(heads[-1], row((where, Tone.DIM)), width)
    return [*heads, *made[first_row : first_row + room]]


def drop_optional_columns(table: Table, width: int) -> Table:
    """Leaves out optional columns, the last one first, until the table fits ``width`` or none is left."""
    while True:
        texts = [
            [_cell_text(cell, column) for cell, column in zip(each, table.columns, strict=True)]
            for each in table.rows
        ]
        widths = _natural_widths([[column.title for column in table.columns], *texts])
        optional = [number for number, column in enumerate(table.columns) if column.is_optional]
        if not optional or sum(widths) + len(COLUMN_GAP) * (len(widths) - 1) <= width:
            return table
        kept = [number for number in range(len(table.columns)) if number != optional[-1]]
        table = replace(
            table,
            columns=tuple(table.columns[number] for number in kept),
            rows=tuple(tuple(each[number] for number in kept) for each in table.rows),
        )


def _fitted_widths(
    columns: Sequence[Column], heads: Sequence[str], cells: Sequence[Sequence[str]], width: int
) -> list[int]:
    """Widths with which the table fits, as far as its numbers allow: first sentences go on below, then heads of numbers, then
    the words of any text; a word is parted only where nothing else helps."""
    natural = _natural_widths([heads, *cells])
    parts = [max(map(longest_part, column)) for column in zip(heads, *cells, strict=True)]
    numbers = [
        max([longest_part(head), *map(len, column)]) for head, *column in zip(heads, *cells, strict=True)
    ]
    sentences = [max(SENTENCE_WIDTH, part) for part in parts]
    words = [max(MIN_TEXT_WIDTH, part) for part in parts]
    is_text = [column.style is CellStyle.TEXT for column in columns]
    widths = natural
    for of_texts, of_numbers in (
        (sentences, natural),
        (sentences, numbers),
        (words, numbers),
        ([MIN_TEXT_WIDTH] * len(columns), numbers),
    ):
        least = [
            text if texts else number
            for texts, text, number in zip(is_text, of_texts, of_numbers, strict=True)
        ]
        widths = fit_widths(widths, width, least)
    return widths


def _natural_widths(rows: Sequence[Sequence[str]]) -> list[int]:
    return [max(map(len, column)) for column in zip(*rows, strict=True)]


def _cell_text(cell: Cell, column: Column) -> str:
    """A cell's text, shortened so that it does not push other columns off the screen."""
    text = printable_line(format_cell(cell, column))
    return text if len(text) <= MAX_CELL_LENGTH else text[: MAX_CELL_LENGTH - 3] + "..."


def _tones_of(cells: Sequence[Cell], label: Tone) -> tuple[Tone, ...]:
    """``label``: of a first cell that has none of its own; faint where what is said of it stands out."""
    tones = [cell.tone if isinstance(cell, ToneText) else Tone.PLAIN for cell in cells]
    if cells and label and not isinstance(cells[0], ToneText):
        tones[0] = Tone.DIM if Tone.BOLD in tones else label
    return tuple(tones)


def _share_first_cells(table: Table, cells: list[list[str]], width: int) -> None:
    """Writes what a group shares down its rows, as far as it goes; what is left stays in the last."""
    starts = [number for number in range(len(cells)) if table.shows_first_cell(number)]
    for start, end in zip(starts, [*starts[1:], len(cells)], strict=True):
        words = wrap(cells[start][0], width)
        for number in range(start, end):
            left = words[number - start :]
            cells[number][0] = " ".join(left if number == end - 1 else left[:1])


def _placed_rows(
    cells: Sequence[str], widths: Sequence[int], columns: Sequence[Column], tones: Sequence[Tone]
) -> Iterator[Row]:
    parts = [wrap(cell, max(1, width)) for cell, width in zip(cells, widths, strict=True)]
    for level in range(max(map(len, parts))):
        words = [part[level] if level < len(part) else "" for part in parts]
        last = max((number for number, word in enumerate(words) if word), default=0)
        pieces: list[tuple[str, str]] = []
        for number, (word, width, column, tone) in enumerate(zip(words, widths, columns, tones, strict=True)):
            if number > last:
                break
            is_text = column.style is CellStyle.TEXT
            blanks = " " * (width - len(word))
            gap = COLUMN_GAP if number else ""
            before, after = (gap, "" if number == last else blanks) if is_text else (gap + blanks, "")
            pieces += [(before, ""), (word, tone), (after, "")]
        yield _join_by_tone(pieces)


def _join_by_tone(pieces: Sequence[tuple[str, str]]) -> Row:
    """The pieces without empty ones, neighbours of one tone as one."""
    joined: list[tuple[str, str]] = []
    for text, tone in pieces:
        if not text:
            continue
        if joined and joined[-1][1] == tone:
            joined[-1] = (joined[-1][0] + text, tone)
        else:
            joined.append((text, tone))
    return tuple(joined)
