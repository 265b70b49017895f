"""A document as Markdown."""

from __future__ import annotations

from collections.abc import Iterator

from kit.document.blocks import (
    BarChart,
    Block,
    Caution,
    CellStyle,
    Column,
    Document,
    Histogram,
    Marked,
    Quote,
    ScatterPlot,
    ScenePlot,
    Table,
    Text,
    format_cell,
)
from kit.document.layout import lines_of
from kit.plain_text import printable_line

_ESCAPED = str.maketrans({"|": "\\|", "<": "&lt;", "*": "\\*", "_": "\\_"})


def document_to_markdown(report: Document) -> str:
    """The whole file."""
    return "\n".join([f"# {_markdown_text(report.title)}", "", *_chapter_lines(report)])


def _chapter_lines(report: Document) -> Iterator[str]:
    for chapter in report.chapters:
        yield f"## {_markdown_text(chapter.title)}"
        yield ""
        for block in chapter.blocks:
            yield from _markdown_lines(block)


def _markdown_lines(block: Block) -> Iterator[str]:
    match block:
        case Table():
            yield from table_to_markdown(block)
        case Text():
            yield _markdown_text(block.whole_text)
        case Marked():
            yield block.text  # its markup is Markdown's
        case Caution():
            yield f"> {_markdown_text(block.text)}"
        case BarChart():
            yield from table_to_markdown(_bar_table(block))
        case Quote():
            yield f"> {_markdown_text(block.student)}: {_markdown_text(block.text)}"
        case Histogram() | ScatterPlot() | ScenePlot():
            return
        case _:
            yield from ("```text", *lines_of([block]), "```")
    yield ""


def _bar_table(bars: BarChart) -> Table:
    columns = (Column("", CellStyle.TEXT), *(Column(group) for group in bars.groups))
    return Table(bars.id, bars.title, columns, tuple((label, *values) for label, values in bars.rows))


def table_to_markdown(table: Table) -> Iterator[str]:
    """Title, head, rows and note."""
    if table.title:
        yield f"**{_markdown_text(table.title)}**"
        yield ""
    yield _table_line(_markdown_text(column.title) for column in table.columns)
    yield _table_line("---" if column.style is CellStyle.TEXT else "---:" for column in table.columns)
    for number, row in enumerate(table.rows):
        shown = (row[0] if table.shows_first_cell(number) else "", *row[1:])
        yield _table_line(
            _markdown_text(format_cell(cell, column))
            for cell, column in zip(shown, table.columns, strict=True)
        )
    if table.note:
        yield ""
        yield _markdown_text(table.note)


def _table_line(cells: Iterator[str]) -> str:
    return f"| {' | '.join(cells)} |"


def _markdown_text(text: str) -> str:
    return printable_line(text).translate(_ESCAPED)
