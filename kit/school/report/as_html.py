"""A report as one HTML file that needs nothing else: no script, no font, no network; every text escaped."""

from __future__ import annotations

from collections.abc import Iterator
from html import escape
from typing import Final

from kit.school.report.as_svg import plot_to_svg
from kit.school.report.as_text import printable_text
from kit.school.report.document import (
    CellStyle,
    ClassReport,
    Quote,
    ReportBlock,
    ReportTable,
    ReportText,
    ReportWarning,
    format_cell,
)

_STYLE: Final = """
body { font-family: sans-serif; line-height: 1.45; color: #222; background: #fff; max-width: 60rem; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.5rem; } h2 { font-size: 1.2rem; margin-top: 2.5rem; border-bottom: 1px solid #999; }
table { border-collapse: collapse; margin: 1rem 0; font-size: 0.9rem; }
caption { text-align: left; font-weight: bold; padding-bottom: 0.3rem; }
th { text-align: left; border-bottom: 1px solid #222; } th, td { padding: 0.15rem 0.9rem 0.15rem 0; vertical-align: top; }
.number { text-align: right; font-variant-numeric: tabular-nums; }
.note { font-size: 0.85rem; margin-top: -0.5rem; } .caution { border-left: 4px solid #a0522d; padding-left: 0.7rem; }
blockquote { margin: 0.3rem 0 1rem 1rem; white-space: pre-wrap; } svg { max-width: 100%; height: auto; display: block; margin: 1rem 0; }
nav a { margin-right: 1rem; }
"""


def report_to_html(report: ClassReport) -> str:
    """The whole page."""
    return "\n".join(_page_lines(report)) + "\n"


def _page_lines(report: ClassReport) -> Iterator[str]:
    title = _escape(report.title)
    yield "<!DOCTYPE html>"
    yield '<html lang="en"><head><meta charset="utf-8">'
    yield "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'\">"
    yield '<meta name="viewport" content="width=device-width, initial-scale=1">'
    yield f"<title>{title}</title><style>{_STYLE}</style></head><body>"
    yield f"<h1>{title}</h1>"
    links = (f'<a href="#{_escape(each.id)}">{_escape(each.title)}</a>' for each in report.chapters)
    yield f"<nav>{' '.join(links)}</nav>"
    for chapter in report.chapters:
        yield f'<section id="{_escape(chapter.id)}"><h2>{_escape(chapter.title)}</h2>'
        for block in chapter.blocks:
            yield from _block_lines(block)
        yield "</section>"
    yield "</body></html>"


def _block_lines(block: ReportBlock) -> Iterator[str]:
    match block:
        case ReportTable():
            yield from _table_lines(block)
        case ReportText():
            yield f"<p>{_escape(block.text)}</p>"
        case ReportWarning():
            yield f'<p class="caution">Note: {_escape(block.text)}</p>'
        case Quote():
            yield f"<p>{_escape(block.student)}:</p><blockquote>{_escape(block.text)}</blockquote>"
        case _:
            yield plot_to_svg(block).rstrip()


def _table_lines(table: ReportTable) -> Iterator[str]:
    kinds = ["" if column.style is CellStyle.TEXT else ' class="number"' for column in table.columns]
    yield f"<table><caption>{_escape(table.title)}</caption><thead><tr>"
    yield "".join(
        f'<th scope="col"{kind}>{_escape(column.title)}</th>'
        for kind, column in zip(kinds, table.columns, strict=True)
    )
    yield "</tr></thead><tbody>"
    for number, row in enumerate(table.rows):
        shown = (row[0] if table.shows_first_cell(number) else "", *row[1:])
        cells = (
            f"<td{kind}>{_escape(format_cell(cell, column))}</td>"
            for kind, cell, column in zip(kinds, shown, table.columns, strict=True)
        )
        yield f"<tr>{''.join(cells)}</tr>"
    yield "</tbody></table>"
    if table.note:
        yield f'<p class="note">{_escape(table.note)}</p>'


def _escape(text: str) -> str:
    return escape(printable_text(text))
