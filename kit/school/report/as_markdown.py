"""A report as Markdown: its tables, texts and warnings, and bars as tables. Other plots stand in the page of ``as_html``."""

from __future__ import annotations

from collections.abc import Iterator

from kit.school.report.as_text import printable_text
from kit.school.report.document import (
    BarChart,
    CellStyle,
    ClassReport,
    Quote,
    ReportBlock,
    ReportTable,
    ReportText,
    ReportWarning,
    TableColumn,
    format_cell,
)

_ESCAPED = str.maketrans({"|": "\\|", "<": "&lt;", "*": "\\*", "_": "\\_"})


def report_to_markdown(report: ClassReport) -> str:
    """The whole file."""
    return "\n".join([f"# {_escape(report.title)}", "", *_chapter_lines(report)])


def _chapter_lines(report: ClassReport) -> Iterator[str]:
    for chapter in report.chapters:
        yield f"## {_escape(chapter.title)}"
        yield ""
        for block in chapter.blocks:
            yield from _block_lines(block)


def _block_lines(block: ReportBlock) -> Iterator[str]:
    match block:
        case ReportTable():
            yield from table_to_markdown(block)
        case ReportText():
            yield _escape(block.text)
        case ReportWarning():
            yield f"> {_escape(block.text)}"
        case BarChart():
            yield from table_to_markdown(_bar_table(block))
        case Quote():
            yield f"> {_escape(block.student)}: {_escape(block.text)}"
        case _:
            return
    yield ""


def _bar_table(bars: BarChart) -> ReportTable:
    columns = (TableColumn("", CellStyle.TEXT), *(TableColumn(group) for group in bars.groups))
    return ReportTable(bars.id, bars.title, columns, tuple((label, *values) for label, values in bars.rows))


def table_to_markdown(table: ReportTable) -> Iterator[str]:
    """Title, head, rows and note."""
    if table.title:
        yield f"**{_escape(table.title)}**"
        yield ""
    yield _row(_escape(column.title) for column in table.columns)
    yield _row("---" if column.style is CellStyle.TEXT else "---:" for column in table.columns)
    for number, row in enumerate(table.rows):
        shown = (row[0] if table.shows_first_cell(number) else "", *row[1:])
        yield _row(
            _escape(format_cell(cell, column)) for cell, column in zip(shown, table.columns, strict=True)
        )
    if table.note:
        yield ""
        yield _escape(table.note)


def _row(cells: Iterator[str]) -> str:
    return f"| {' | '.join(cells)} |"


def _escape(text: str) -> str:
    return printable_text(text).translate(_ESCAPED)
