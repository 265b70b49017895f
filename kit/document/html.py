"""A document as one HTML page that needs nothing else."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from html import escape
from itertools import islice
from types import MappingProxyType
from typing import Final

from kit.document.blocks import (
    BarChart,
    Block,
    Caution,
    CellStyle,
    Code,
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
from kit.document.markup import StyledText, TextStyle, parse_markup, styled_pieces
from kit.document.svg import plot_to_svg
from kit.plain_text import escape_controls, printable_line

_STYLE: Final = """
:root { color-scheme: light dark; --text: #222; --page: #fff; --line: #999; --code: #f2f2ef; --link: #1a4f8a; --mark: #a0522d; }
@media (prefers-color-scheme: dark) {
:root { --text: #ddd; --page: #1b1d20; --line: #777; --code: #2a2d31; --link: #8ab8f0; --mark: #e0925a; } }
body { font-family: sans-serif; line-height: 1.45; color: var(--text); background: var(--page); max-width: 60rem; margin: 2rem auto;
padding: 0 1rem; overflow-wrap: break-word; }
h1 { font-size: 1.5rem; } h2 { font-size: 1.2rem; margin-top: 2.5rem; border-bottom: 1px solid var(--line); }
a { color: var(--link); } pre, code { font-family: monospace; background: var(--code); } code { padding: 0 0.2rem; }
pre { padding: 0.5rem 0.7rem; overflow-x: auto; line-height: 1.3; } .wide { overflow-x: auto; }
table { border-collapse: collapse; margin: 1rem 0; font-size: 0.9rem; }
caption { text-align: left; font-weight: bold; padding-bottom: 0.3rem; }
th { text-align: left; border-bottom: 1px solid var(--text); } th, td { padding: 0.15rem 0.9rem 0.15rem 0; vertical-align: top; }
.number { text-align: right; font-variant-numeric: tabular-nums; }
.note { font-size: 0.85rem; margin-top: -0.5rem; } .caution { border-left: 4px solid var(--mark); padding-left: 0.7rem; }
blockquote { margin: 0.3rem 0 1rem 1rem; white-space: pre-wrap; } svg { max-width: 100%; height: auto; display: block; margin: 1rem 0; }
nav { columns: 18rem; column-gap: 1.5rem; } nav a { display: block; }
"""

Links = Mapping[str, str]
"""Addresses of other pages, by the code that names each in a text."""


def document_to_html(report: Document, links: Links = MappingProxyType({})) -> str:
    """The whole page. Code that ``links`` knows becomes a link; the first of them also stands at the top of the page."""
    return "\n".join(_page_lines(report, links)) + "\n"


def table_to_html(table: Table) -> str:
    """One table as a part of a page, as a notebook shows it."""
    return "\n".join(_table_lines(table)) + "\n"


def _page_lines(report: Document, links: Links) -> Iterator[str]:
    title = _html_text(report.title)
    yield "<!DOCTYPE html>"
    yield '<html lang="en"><head><meta charset="utf-8">'
    yield "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'\">"
    yield '<meta name="viewport" content="width=device-width, initial-scale=1">'
    yield f"<title>{title}</title><style>{_STYLE}</style></head><body>"
    for name, address in islice(links.items(), 1):
        yield f'<nav><a href="{_html_text(address)}">{_html_text(name)}</a></nav>'
    yield f"<h1>{title}</h1>"
    inside = (f'<a href="#{_html_text(each.id)}">{_html_text(each.title)}</a>' for each in report.chapters)
    yield f"<nav>{' '.join(inside)}</nav>"
    for chapter in report.chapters:
        yield f'<section id="{_html_text(chapter.id)}"><h2>{_html_text(chapter.title)}</h2>'
        for block in chapter.blocks:
            yield from _html_lines(block, links)
        yield "</section>"
    yield "</body></html>"


def _html_lines(block: Block, links: Links) -> Iterator[str]:
    match block:
        case Table():
            yield from _table_lines(block)
        case Code():
            yield f"<pre>{escape(chr(10).join(map(escape_controls, block.lines)))}</pre>"
        case Text():
            yield f"<p>{_html_text(block.whole_text)}</p>"
        case Marked():
            yield from _marked_html(block, links)
        case Caution():
            yield f'<p class="caution">Note: {_html_text(block.text)}</p>'
        case Quote():
            yield f"<p>{_html_text(block.student)}:</p><blockquote>{_html_text(block.text)}</blockquote>"
        case BarChart() | Histogram() | ScatterPlot() | ScenePlot():
            yield plot_to_svg(block).rstrip()
        case _:
            yield f"<pre>{escape(chr(10).join(lines_of([block])))}</pre>"


def _marked_html(block: Marked, links: Links) -> Iterator[str]:
    is_list = False
    for part in parse_markup(block.text):
        if is_list != (part.kind == "bullet"):
            is_list = not is_list
            yield "<ul>" if is_list else "</ul>"
        if part.kind == "code":
            yield f"<pre>{escape(chr(10).join(part.lines))}</pre>"
        else:
            words = "".join(_piece_html(piece, links) for piece in styled_pieces(part))
            yield f"<li>{words}</li>" if is_list else f"<p>{words}</p>"
    if is_list:
        yield "</ul>"


def _piece_html(piece: StyledText, links: Links) -> str:
    words = _html_text(piece.text)
    match piece.style:
        case TextStyle.CODE if piece.text in links:
            return f'<a href="{_html_text(links[piece.text])}"><code>{words}</code></a>'
        case TextStyle.CODE:
            return f"<code>{words}</code>"
        case TextStyle.BOLD:
            return f"<strong>{words}</strong>"
        case _:
            return words


def _table_lines(table: Table) -> Iterator[str]:
    kinds = ["" if column.style is CellStyle.TEXT else ' class="number"' for column in table.columns]
    caption = f"<caption>{_html_text(table.title)}</caption>" if table.title else ""
    yield f'<div class="wide"><table>{caption}'
    if any(column.title for column in table.columns):
        heads = (
            f'<th scope="col"{kind}>{_html_text(column.title)}</th>'
            for kind, column in zip(kinds, table.columns, strict=True)
        )
        yield f"<thead><tr>{''.join(heads)}</tr></thead>"
    yield "<tbody>"
    for number, row in enumerate(table.rows):
        shown = (row[0] if table.shows_first_cell(number) else "", *row[1:])
        cells = (
            f"<td{kind}>{_html_text(format_cell(cell, column))}</td>"
            for kind, cell, column in zip(kinds, shown, table.columns, strict=True)
        )
        yield f"<tr>{''.join(cells)}</tr>"
    yield "</tbody></table></div>"
    if table.note:
        yield f'<p class="note">{_html_text(table.note)}</p>'


def _html_text(text: str) -> str:
    return escape(printable_line(text))
