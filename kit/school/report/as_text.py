"""A report in characters: 80 columns at most, with plots that need no colour and, if asked, nothing but ASCII."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from textwrap import wrap
from typing import Final

import numpy as np

from kit.plain_text import is_printable
from kit.render.encode import ENCODERS
from kit.render.world_text import scene_rows
from kit.school.report.document import (
    BarChart,
    CellStyle,
    ClassReport,
    Histogram,
    Quote,
    ReportBlock,
    ReportTable,
    ReportText,
    ReportWarning,
    ScatterPlot,
    ScenePlot,
    TableColumn,
    format_cell,
)

WIDTH: Final = 79
GAP: Final = "  "
MIN_TEXT_WIDTH: Final = 8
"""Columns that a column of words keeps when room is short."""
MAX_CELL_LENGTH: Final = 120
BAR_WIDTH: Final = 40
SCATTER_SIZE: Final = (56, 15)
"""Columns and rows of the field in which points are drawn."""
SCENE_ROWS: Final = 18
"""Most rows of a map."""


@dataclass(frozen=True, slots=True)
class PlotGlyphs:
    """Characters that plots are drawn with."""

    bars: tuple[str, ...]
    """Bars of the first, second and third group, distinct in shape."""
    point: str
    line: str
    encoder: str
    """What maps are drawn with."""


BLOCK_GLYPHS: Final = PlotGlyphs(bars=("█", "▒", "░"), point="o", line="·", encoder="braille")
ASCII_GLYPHS: Final = PlotGlyphs(bars=("#", "=", "-"), point="o", line=".", encoder="ascii")


def report_lines(report: ClassReport, glyphs: PlotGlyphs = BLOCK_GLYPHS) -> Iterator[str]:
    """The whole report, line by line."""
    yield from wrap(printable_text(report.title), WIDTH)
    for chapter in report.chapters:
        yield ""
        title = printable_text(chapter.title)
        yield title
        yield "=" * min(len(title), WIDTH)
        for block in chapter.blocks:
            if not isinstance(block, Quote):
                yield ""
            yield from block_lines(block, glyphs)


def block_lines(block: ReportBlock, glyphs: PlotGlyphs = BLOCK_GLYPHS) -> Iterator[str]:
    """The lines of one table, plot, text, warning or quote."""
    match block:
        case ReportTable():
            yield from table_lines(block)
        case BarChart():
            yield from _bar_lines(block, glyphs)
        case Histogram():
            yield from _histogram_lines(block, glyphs)
        case ScatterPlot():
            yield from _scatter_lines(block, glyphs)
        case ScenePlot():
            yield from _scene_lines(block, glyphs)
        case ReportText():
            yield from wrap(printable_text(block.text), WIDTH)
        case ReportWarning():
            yield from wrap(printable_text(block.text), WIDTH, initial_indent="! ", subsequent_indent="  ")
        case Quote():
            head = f"  {printable_text(block.student)}: "
            yield from wrap(printable_text(block.text), WIDTH, initial_indent=head, subsequent_indent=" " * 6)


def printable_text(text: str) -> str:
    """Removes control characters that a terminal would obey, and joins lines to one."""
    return "".join(c if is_printable(c) else " " if c.isspace() else "?" for c in text)


def table_lines(table: ReportTable) -> Iterator[str]:
    """Its title, heads, cells and note. Words that do not fit their column go on below."""
    yield from wrap(printable_text(table.title), WIDTH)
    cells = [
        [
            _shorten(printable_text(format_cell(cell, column)))
            for cell, column in zip(row, table.columns, strict=True)
        ]
        for row in table.rows
    ]
    heads = [column.title for column in table.columns]
    widths = _column_widths([heads, *cells], table.columns)
    yield from _table_line(heads, widths, table.columns)
    yield GAP.join("-" * width for width in widths)
    for rows in _grouped_rows(table, cells):
        if table.grouped:
            _wrap_cells(rows, widths[0])
        for row in rows:
            yield from _table_line(row, widths, table.columns)
    if table.note:
        yield from wrap(printable_text(table.note), WIDTH)


def _shorten(text: str) -> str:
    """Shortens a cell's text, so that it does not push other columns off the screen."""
    return text if len(text) <= MAX_CELL_LENGTH else text[: MAX_CELL_LENGTH - 3] + "..."


def _grouped_rows(table: ReportTable, cells: list[list[str]]) -> Iterator[list[list[str]]]:
    """The rows in groups; without groups each for itself."""
    starts = [i for i in range(len(cells)) if not table.grouped or table.shows_first_cell(i)]
    for start, end in zip(starts, [*starts[1:], len(cells)], strict=True):
        yield cells[start:end]


def _wrap_cells(rows: list[list[str]], width: int) -> None:
    """Writes what a group shares down its rows, as far as it goes; what is left stays in the last."""
    words = wrap(rows[0][0], width)
    for number, row in enumerate(rows):
        last = number == len(rows) - 1
        row[0] = " ".join(words[number:]) if last else "".join(words[number : number + 1])


def _column_widths(rows: Sequence[Sequence[str]], columns: Sequence[TableColumn]) -> list[int]:
    widths = [max(len(row[i]) for row in rows) for i in range(len(columns))]
    over = sum(widths) + len(GAP) * (len(widths) - 1) - WIDTH
    while over > 0:
        texts = [
            i
            for i, column in enumerate(columns)
            if column.style is CellStyle.TEXT and widths[i] > MIN_TEXT_WIDTH
        ]
        if not texts:
            break
        widest = max(texts, key=lambda i: widths[i])
        widths[widest] -= 1
        over -= 1
    return widths


def _table_line(cells: Sequence[str], widths: Sequence[int], columns: Sequence[TableColumn]) -> Iterator[str]:
    parts = [wrap(cell, width) or [""] for cell, width in zip(cells, widths, strict=True)]
    for level in range(max(map(len, parts))):
        words = (part[level] if level < len(part) else "" for part in parts)
        yield GAP.join(
            f"{word:<{width}}" if column.style is CellStyle.TEXT else f"{word:>{width}}"
            for word, width, column in zip(words, widths, columns, strict=True)
        ).rstrip()


def _bar_lines(bars: BarChart, glyphs: PlotGlyphs) -> Iterator[str]:
    yield from wrap(printable_text(bars.title), WIDTH)
    groups = max(map(len, bars.groups))
    labels = min(max((len(label) for label, _ in bars.rows), default=0), WIDTH - BAR_WIDTH - groups - 11)
    indent = " " * (labels + groups + 3)
    yield f"{indent}{bars.low:<{BAR_WIDTH // 2}g}{bars.high:>{BAR_WIDTH - BAR_WIDTH // 2}g}"
    for label, values in bars.rows:
        text = wrap(printable_text(label), labels) or [""]
        text += [""] * (len(values) - len(text))
        for i, part in enumerate(text):
            if i >= len(values):
                yield part
                continue
            value, glyph = values[i], glyphs.bars[i % len(glyphs.bars)]
            head = f"{part:<{labels}} {bars.groups[i]:<{groups}} |"
            if math.isnan(value):
                yield f"{head} nobody".rstrip()
                continue
            share = min(max((value - bars.low) / (bars.high - bars.low), 0.0), 1.0)
            yield f"{head}{glyph * round(share * BAR_WIDTH):<{BAR_WIDTH}}| {value:.2f}"


def _histogram_lines(histogram: Histogram, glyphs: PlotGlyphs) -> Iterator[str]:
    yield from wrap(printable_text(histogram.title), WIDTH)
    labels = [f"{low:g} to {high:g}" for low, high in zip(histogram.edges, histogram.edges[1:], strict=False)]
    width = max(map(len, labels))
    most = max((*histogram.counts, 1))
    unit = max(1, -(-most // BAR_WIDTH))
    scale = 2 if 2 * most <= BAR_WIDTH else 1
    for label, count in zip(labels, histogram.counts, strict=True):
        yield f"{label:>{width}} |{glyphs.bars[0] * round(count / unit * scale)} {count}"


def _scatter_lines(scatter: ScatterPlot, glyphs: PlotGlyphs) -> Iterator[str]:
    yield from wrap(printable_text(scatter.title), WIDTH)
    columns, rows = SCATTER_SIZE
    (left, right), (low, high) = scatter.x_range, scatter.y_range
    field = [[" "] * columns for _ in range(rows)]

    def place(x: float, y: float) -> tuple[int, int]:
        return (
            rows - 1 - round((y - low) / (high - low) * (rows - 1)),
            round((x - left) / (right - left) * (columns - 1)),
        )

    if scatter.line is not None:
        slope, height = scatter.line
        for x in np.linspace(left, right, columns):
            y = slope * x + height
            if low <= y <= high:
                row, column = place(x, y)
                field[row][column] = glyphs.line
    seen: dict[tuple[int, int], int] = {}
    for x, y in scatter.points:
        seen[place(x, y)] = seen.get(place(x, y), 0) + 1
    for (row, column), count in seen.items():
        field[row][column] = glyphs.point if count == 1 else str(count) if count < 10 else "+"
    yield f"{printable_text(scatter.y)} (up) by {printable_text(scatter.x)} (right)"
    margin = max(len(f"{low:g}"), len(f"{high:g}"))
    for number, dots in enumerate(field):
        label = {0: f"{high:g}", rows - 1: f"{low:g}"}.get(number, "")
        yield f"{label:>{margin}} |{''.join(dots)}".rstrip()
    yield f"{'':>{margin}} +{'-' * columns}"
    yield f"{'':>{margin}}  {left:<{columns // 2}g}{right:>{columns - columns // 2}g}"
    trend = f"; {glyphs.line} the trend" if scatter.line is not None else ""
    yield f"{'':>{margin}}  {glyphs.point} one student, a digit several{trend}"


def _scene_lines(plot: ScenePlot, glyphs: PlotGlyphs) -> Iterator[str]:
    yield from wrap(printable_text(plot.title), WIDTH)
    rows = scene_rows(plot.scene, WIDTH, SCENE_ROWS, ENCODERS[glyphs.encoder](True))
    yield from (row.rstrip() for row in rows if row.strip())
