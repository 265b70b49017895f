"""The one layout: places blocks in rows of a width. Plain lines are its rows without tones."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Final, NamedTuple

from kit.document.blocks import (
    BarChart,
    Block,
    Caution,
    Choice,
    Choices,
    Code,
    Document,
    Histogram,
    KeyLine,
    Marked,
    Picture,
    Quote,
    RatingScale,
    ScatterPlot,
    ScenePlot,
    Table,
    Text,
    Tone,
)
from kit.document.code_lines import broken_code
from kit.document.glyphs import BLOCK_GLYPHS, WIDTH, PlotGlyphs, diagram_lines
from kit.document.markup import TextStyle, parse_markup, wrap_blocks
from kit.document.rows import Row, StyledText, entry_rows, row, row_text
from kit.document.tables import table_rows
from kit.plain_text import printable_line, wrap

POINT_WIDTH: Final = 12
"""Columns of a point of a scale where there is room."""
_STYLES: Final = {TextStyle.PLAIN: Tone.PLAIN, TextStyle.CODE: Tone.CODE, TextStyle.BOLD: Tone.BOLD}


@dataclass(frozen=True, slots=True)
class Page:
    """Where blocks are placed."""

    width: int = WIDTH
    """Columns of the text, without the margin."""
    margin: int = 0
    """Blank columns before each row."""
    is_heard: bool = False
    """Whether it is read line by line, also aloud: a scale is a sentence, and no mark shows a state."""
    is_roomy: bool = False
    """Whether there is an empty row after each choice."""
    is_beside: bool = False
    """Whether something else stands on its left, so that its rows cannot be copied together."""
    glyphs: PlotGlyphs = BLOCK_GLYPHS


HEARD: Final = Page(width=78, is_heard=True)
"""A page for standard output, which a screen reader may read."""


class Placed(NamedTuple):
    """The rows of a page."""

    rows: list[Row]
    starts: list[int]
    """For each block the number of its first row."""


def place(blocks: Sequence[Block], page: Page) -> Placed:
    """Places the blocks one below the other, with an empty row between two that are not tight."""
    rows: list[Row] = []
    starts: list[int] = []
    for block in blocks:
        if rows and not getattr(block, "is_tight", isinstance(block, Quote)):
            rows.append(())
        starts.append(len(rows))
        rows += block_rows(block, page)
    return Placed(rows, starts)


def rows_of(blocks: Sequence[Block], page: Page) -> list[Row]:
    """The rows of a page alone."""
    return place(blocks, page).rows


def sections_of(blocks: Sequence[Block], page: Page) -> list[list[Row]]:
    """The rows of a page in parts that are not to be parted: each paragraph with what stands right below it, up to the next one.

    >>> [len(each) for each in sections_of([Text("a"), Text("b", is_tight=True), Text("c")], Page())]
    [3, 1]
    """
    rows, starts = place(blocks, page)
    firsts = [
        start
        for block, start in zip(blocks, starts, strict=True)
        if not start or (isinstance(block, Text) and not block.is_tight)
    ]
    return [rows[first:last] for first, last in pairwise([*firsts, len(rows)])]


def lines_of(blocks: Sequence[Block], page: Page = HEARD) -> list[str]:
    """The rows without tones."""
    return [row_text(each) for each in rows_of(blocks, page)]


def document_lines(document: Document, glyphs: PlotGlyphs = BLOCK_GLYPHS) -> Iterator[str]:
    """A whole document, line by line, 79 columns wide."""
    page = Page(is_heard=True, glyphs=glyphs)
    yield from wrap(printable_line(document.title), WIDTH)
    for chapter in document.chapters:
        title = printable_line(chapter.title)
        yield from ("", title, "=" * min(len(title), WIDTH), "")
        yield from lines_of(chapter.blocks, page)


def block_rows(block: Block, page: Page) -> list[Row]:
    """The rows of one block. What is read line by line keeps the marks of code in sentences, for it has no tones."""
    made = _placed_rows(block, page)
    return _toned_code(made) if isinstance(block, (Text, Choices, KeyLine)) and not page.is_heard else made


def _toned_code(rows: list[Row]) -> list[Row]:
    """Gives `code` in sentences its tone instead of its marks, as in marked text; nothing where a mark has no second one."""
    marks = sum(text.count("`") for each in rows for text, _ in each)
    if not marks or marks % 2:
        return rows
    made, is_code = [], False
    for each in rows:
        parts: list[StyledText] = []
        for text, tone in each:
            for number, piece in enumerate(text.split("`")):
                is_code ^= number > 0
                parts.append((piece, Tone.CODE if is_code and piece.strip() else tone))
        made.append(_parts(*parts))
    return made


def _placed_rows(block: Block, page: Page) -> list[Row]:
    margin = " " * page.margin
    match block:
        case Choices():
            return [each for entry in block.entries for each in _choice_rows(entry, page)]
        case RatingScale():
            return _scale_rows(block, page)
        case KeyLine():
            return _key_line_rows(block, page)
        case Code():
            return _code_rows(block, page)
        case Marked():
            return _marked_rows(block, page)
        case Picture() if max(map(len, block.lines), default=0) > page.width:
            return _block_rows(block, page)  # made for the whole width
        case _:
            return [(row(margin) + each if margin and each else each) for each in _block_rows(block, page)]


def _block_rows(block: Block, page: Page) -> list[Row]:
    """The rows of a block, without the margin on their left."""
    match block:
        case Text():
            return [
                each
                for part in block.text.splitlines() or [""]
                for each in _text_rows(replace(block, text=part), page)
            ]
        case Picture():
            indent = " " * block.indent
            lines = diagram_lines(block.lines) if block.is_diagram and not page.is_heard else block.lines
            return [row((f"{indent}{line}".rstrip(), block.tone)) for line in lines]
        case Table():
            return list(_table_rows(block, page))
        case Caution():
            return [row(line) for line in wrap(printable_line(block.text), page.width, "! ", "  ")]
        case Quote():
            head = f"  {printable_line(block.student)}: "
            return [row(line) for line in wrap(printable_line(block.text), page.width, head, " " * 6)]
        case BarChart() | Histogram() | ScatterPlot() | ScenePlot():
            from kit.document.plots import plot_lines  # numpy, which few pages need

            return [row(line) for line in plot_lines(block, page.glyphs)]
    raise TypeError(f"{type(block).__name__} is placed with its margin")


def _text_rows(block: Text, page: Page) -> list[Row]:
    """One paragraph with its lead and its tail, which stays with the last word."""
    text = printable_line(block.text)
    lead = f"{block.lead} " if block.lead and text else block.lead
    held = text + "\0" * len(block.tail)  # wrapped as one word, and taken off again
    begin, later = " " * (block.indent + len(lead)), " " * (block.indent + block.hang)
    first, *others = (line.replace("\0", "") for line in wrap(held, page.width, begin, later))
    made: list[Row] = [
        _parts(
            (" " * block.indent, ""), (lead, block.lead_tone), (first[block.indent + len(lead) :], block.tone)
        )
    ]
    made += [_parts((line, block.tone)) for line in others]
    if block.tail:
        made[-1] = _parts(*made[-1], (block.tail, Tone.DIM))
    return made


def _parts(*parts: StyledText) -> Row:
    return tuple((text, tone) for text, tone in parts if text)


def _marked_rows(block: Marked, page: Page) -> list[Row]:
    margin = row(" " * page.margin) if page.margin else ()
    made: list[Row] = []
    for each in wrap_blocks(parse_markup(block.text), page.width):
        if len(each) == 1 and len(each[0].text) > page.width:
            made += _code_line_rows(each[0].text, page)
        else:
            made.append((*margin, *((piece.text, _STYLES[piece.style]) for piece in each)) if each else ())
    return made


def _code_rows(block: Code, page: Page) -> list[Row]:
    """Commands and code, each line on as many rows as it needs."""
    return [each for line in block.lines for each in _code_line_rows(" " * block.indent + line, page)]


def _code_line_rows(line: str, page: Page) -> list[Row]:
    """What goes on in the middle of a word has no margin: a shell joins it with what stands before the backslash. Where that
    cannot be copied, it is indented like the word's beginning, and a word may reach into the margin on the right."""
    room = page.width + page.margin if page.is_beside else page.width
    made: list[Row] = []
    indent = 0
    for before, part in pairwise(["", *broken_code(line, room)]):
        margin = " " * page.margin
        if before.endswith("\\") and not before.endswith(" \\"):
            margin += " " * min(indent, room - len(part))
            margin = margin if page.is_beside else ""
        else:
            indent = len(part) - len(part.lstrip())
        made.append(_parts((margin, ""), (part, Tone.CODE)))
    return made


def _choice_rows(entry: Choice, page: Page) -> list[Row]:
    mark = " " if page.is_heard else entry.mark
    text = printable_line(entry.text)
    made = entry_rows(mark, entry.key, text, entry.tone, page.width, is_open=entry.is_open)
    return [*made, ()] if page.is_roomy else made


def _key_line_rows(block: KeyLine, page: Page) -> list[Row]:
    """The question, and its keys after it; below it, as entries, where they do not fit."""
    parts: list[str | StyledText] = [" " * page.margin, (block.text, Tone.BOLD)]
    for entry in block.entries:
        parts += ["  ", (entry.key, Tone.KEY), (f" {entry.text}", entry.tone)]
    made = row(*parts)
    if len(row_text(made)) <= page.width + page.margin:
        return [made]
    return [row(*parts[:2]), *(each for entry in block.entries for each in _choice_rows(entry, page))]


def _scale_rows(block: RatingScale, page: Page) -> list[Row]:
    """The points beside each other, and below them what the lowest and the highest mean."""
    points = block.points
    if page.is_heard:
        text = f"{points[0]}: {block.low} ... {points[-1]}: {block.high}"
        return [row(f"  {line}") for line in wrap(text, page.width - 2)]
    width = max(3, min(POINT_WIDTH, page.width // len(points)))
    line: list[StyledText] = [(" " * page.margin, "")]
    for index, point in enumerate(points):
        sign = str(point)
        shown = (
            (("[", Tone.BOLD), (sign, Tone.CHOSEN), ("]", Tone.BOLD))
            if index == block.chosen
            else ((" ", ""), (sign, Tone.KEY), (" ", ""))
        )
        line += [*shown, (" " * (width - 3), "")]
    indent, used = " " * (page.margin + 1), (len(points) - 1) * width + 1
    gap = used - len(block.low) - len(block.high)
    if gap > 0:
        return [tuple(line), row(indent, (block.low + " " * gap + block.high, Tone.DIM))]
    words = (f"{points[0]} {block.low}", f"{points[-1]} {block.high}")
    return [tuple(line), *(row(indent, (each, Tone.DIM)) for each in words)]


def _table_rows(table: Table, page: Page) -> Iterator[Row]:
    if table.title:
        yield from (row((line, Tone.TITLE)) for line in wrap(printable_line(table.title), page.width))
    placed = table_rows(table, page.width - table.indent)
    indent = row(" " * table.indent) if table.indent else ()
    for each in (*placed.heads, *(each for entry in placed.entries for each in entry)):
        yield (*indent, *each)
    if table.note:
        yield from (row((line, Tone.DIM)) for line in wrap(printable_line(table.note), page.width))


def text_blocks(lines: Iterable[str]) -> list[Text]:
    """Paragraphs that follow each other without an empty row."""
    return [Text(line, is_tight=True) for line in lines]
