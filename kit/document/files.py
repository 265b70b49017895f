"""A document as files: CSV and JSON for machines, Markdown, one HTML page that needs nothing else, and plots as SVG."""

from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from html import escape
from types import MappingProxyType
from typing import Any, Final

from kit.document.blocks import (
    BarChart,
    Block,
    Caution,
    Cell,
    CellStyle,
    Code,
    Column,
    Document,
    Histogram,
    Marked,
    Plot,
    Quote,
    ScatterPlot,
    ScenePlot,
    Table,
    Text,
    ToneText,
    format_cell,
)
from kit.document.layout import lines_of
from kit.document.markup import StyledText, TextStyle, parse_markup, styled_pieces
from kit.plain_text import escape_controls, printable_text
from kit.render.animation_files import svg_picture

WIDTH: Final = 640
MARGIN: Final = 16
LINE: Final = 18
"""Height of a line of text."""
LABEL: Final = 34
"""Characters of one line of a bar's label."""

_SHADES: Final = ("#b9c6d6", "#2f5d8a", "#e8b04a")
_FONT: Final = 'font-family="sans-serif" font-size="12" fill="#222222" stroke="none"'


Scale = Callable[[float], float]


def plot_to_svg(plot: Plot) -> str:
    """The whole file; inside an HTML page it can stand as it is."""
    match plot:
        case BarChart():
            body, height = _draw_bars(plot)
        case Histogram():
            body, height = _draw_histogram(plot)
        case ScatterPlot():
            body, height = _draw_scatter(plot)
        case ScenePlot():
            return svg_picture(plot.scene, size=(WIDTH, WIDTH), title=plot.title)
    size = f'viewBox="0 0 {WIDTH} {height}" width="{WIDTH}" height="{height}"'
    parts = (
        f'<svg xmlns="http://www.w3.org/2000/svg" {size} role="img" {_FONT}>',
        f"<title>{_svg_text(plot.title)}</title>",
        f'<rect width="{WIDTH}" height="{height}" fill="#ffffff"/>',
        *(
            _draw_text(MARGIN, MARGIN + LINE * (1 + number), line, weight="bold")
            for number, line in enumerate(_title_lines(plot.title))
        ),
        *body,
        "</svg>",
    )
    return "\n".join(parts) + "\n"


def _title_lines(title: str, most: int = 84) -> list[str]:
    """A title in rows that fit the picture's width."""
    rows = [""]
    for word in title.split():
        if rows[-1] and len(rows[-1]) + 1 + len(word) > most:
            rows.append("")
        rows[-1] = f"{rows[-1]} {word}".strip()
    return rows


def _plot_top(title: str) -> float:
    return MARGIN + LINE * (len(_title_lines(title)) + 0.8)


def _draw_bars(bars: BarChart) -> tuple[list[str], int]:
    thick, apart = 14, 10
    left, right = 232, WIDTH - 60
    top = _plot_top(bars.title) + LINE
    step = len(bars.groups) * thick + apart
    bottom = top + step * len(bars.rows)

    def x(value: float) -> float:
        return left + (min(max(value, bars.low), bars.high) - bars.low) / (bars.high - bars.low) * (
            right - left
        )

    body = list(_draw_legend(bars.groups, left, top - LINE))
    body += _draw_grid(bars.low, bars.high, x, top, bottom)
    for number, (label, values) in enumerate(bars.rows):
        y = top + apart / 2 + number * step
        lines = _title_lines(label, LABEL)[: len(values) + 1]
        first = y + (step - apart) / 2 + 4 - (len(lines) - 1) * 6.5
        body += [_draw_text(left - 8, first + 13 * i, line, anchor="end") for i, line in enumerate(lines)]
        for i, value in enumerate(values):
            at = y + i * thick
            if math.isnan(value):
                body.append(_draw_text(left + 4, at + thick - 3, "nobody"))
                continue
            body.append(_draw_bar(left, at, x(value) - left, thick - 2, i))
            body.append(_draw_text(x(value) + 4, at + thick - 3, f"{value:.2f}"))
    return body, round(bottom + 2 * LINE)


def _draw_histogram(histogram: Histogram) -> tuple[list[str], int]:
    left, right = 56, WIDTH - MARGIN
    top = _plot_top(histogram.title)
    bottom = top + 200
    most = max((*histogram.counts, 1))
    wide = (right - left) / len(histogram.counts)
    body = []
    for count in _whole_ticks(most):
        y = bottom - count / most * (bottom - top)
        body.append(_draw_stroke(left, y, right, y, "#dddddd"))
        body.append(_draw_text(left - 8, y + 4, str(count), anchor="end"))
    for i, count in enumerate(histogram.counts):
        height = count / most * (bottom - top)
        body.append(_draw_bar(left + i * wide + 1, bottom - height, wide - 2, height, 1))
    for i, edge in enumerate(histogram.edges):
        body.append(_draw_text(left + i * wide, bottom + LINE, f"{edge:g}", anchor="middle"))
    body.append(_draw_stroke(left, bottom, right, bottom, "#222222"))
    return body, round(bottom + 2 * LINE)


def _draw_scatter(scatter: ScatterPlot) -> tuple[list[str], int]:
    left, right = 72.0, WIDTH - 2.0 * MARGIN
    top = _plot_top(scatter.title) + LINE
    bottom = top + 300
    (least_x, most_x), (least_y, most_y) = scatter.x_range, scatter.y_range

    def x(value: float) -> float:
        return left + (value - least_x) / (most_x - least_x) * (right - left)

    def y(value: float) -> float:
        return bottom - (value - least_y) / (most_y - least_y) * (bottom - top)

    body = list(_draw_grid(least_x, most_x, x, top, bottom))
    for value in _axis_ticks(least_y, most_y):
        body.append(_draw_stroke(left, y(value), right, y(value), "#dddddd"))
        body.append(_draw_text(left - 8, y(value) + 4, f"{value:.3g}", anchor="end"))
    if scatter.line is not None:
        ends = _clip_line(scatter.line, scatter.x_range, scatter.y_range)
        if ends is not None:
            (x1, y1), (x2, y2) = ends
            body.append(_draw_stroke(x(x1), y(y1), x(x2), y(y2), "#a0522d", width=2, dash="6 4"))
    seen: dict[tuple[float, float], int] = {}
    for point in scatter.points:
        seen[point] = seen.get(point, 0) + 1
    for (px, py), count in seen.items():
        body.append(
            f'<circle cx="{x(px):.1f}" cy="{y(py):.1f}" r="{4 + 2 * (count - 1)}" fill="#2f5d8a" fill-opacity="0.8"/>'
        )
    body.append(_draw_text((left + right) / 2, bottom + 2 * LINE, scatter.x, anchor="middle"))
    body.append(_draw_text(left, top - 8, f"{scatter.y} (up)", anchor="start"))
    return body, round(bottom + 2.8 * LINE)


def _clip_line(
    line: tuple[float, float], across: tuple[float, float], up: tuple[float, float]
) -> tuple[tuple[float, float], tuple[float, float]] | None:
    """The part of a trend line that lies in the field; None if none does."""
    slope, height = line
    low, high = across
    if slope:
        at = sorted(((up[0] - height) / slope, (up[1] - height) / slope))
        low, high = max(low, at[0]), min(high, at[1])
    elif not up[0] <= height <= up[1]:
        return None
    return ((low, slope * low + height), (high, slope * high + height)) if low < high else None


def _draw_grid(low: float, high: float, x: Scale, top: float, bottom: float) -> Iterator[str]:
    """Lines and numbers along the horizontal scale."""
    for value in _axis_ticks(low, high):
        yield _draw_stroke(x(value), top, x(value), bottom, "#dddddd")
        yield _draw_text(x(value), bottom + LINE, f"{value:.3g}", anchor="middle")
    yield _draw_stroke(x(low), bottom, x(high), bottom, "#222222")


def _axis_ticks(low: float, high: float) -> list[float]:
    """Whole numbers where they are few enough, else fifths of the range."""
    steps = int(high - low) if 2 <= high - low <= 10 and float(high - low).is_integer() else 5
    return [low + (high - low) * i / steps for i in range(steps + 1)]


def _draw_legend(groups: Sequence[str], left: float, y: float) -> Iterator[str]:
    for i, name in enumerate(groups):
        at = left + i * 120
        yield _draw_bar(at, y - 2, 14, 12, i)
        yield _draw_text(at + 20, y + 8, name)


def _draw_bar(x: float, y: float, width: float, height: float, group: int) -> str:
    """The first group is light with an outline, the second dark, the third middling with a broken outline."""
    shade = _SHADES[group % len(_SHADES)]
    dash = ' stroke-dasharray="3 2"' if group % len(_SHADES) == 2 else ""
    return (
        f'<rect x="{x:.1f}" y="{y:.1f}" width="{max(width, 0):.1f}" height="{height:.1f}" fill="{shade}" '
        f'stroke="#222222" stroke-width="0.8"{dash}/>'
    )


def _draw_stroke(
    x1: float, y1: float, x2: float, y2: float, colour: str, *, width: float = 1, dash: str = ""
) -> str:
    dashes = f' stroke-dasharray="{dash}"' if dash else ""
    return (
        f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" stroke="{colour}" '
        f'stroke-width="{width:g}"{dashes}/>'
    )


def _draw_text(x: float, y: float, text: str, *, anchor: str = "start", weight: str = "normal") -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" font-weight="{weight}">{_svg_text(text)}</text>'


def _whole_ticks(most: int) -> range:
    return range(0, most + 1, max(1, math.ceil(most / 8)))


def _svg_text(text: str) -> str:
    """Escaped, and without the characters that XML cannot hold."""
    return escape("".join(c for c in text if c.isprintable()))


_FORMULA = ("=", "+", "-", "@", "\t", "\r", "|", "%", "\uff1d", "\uff0b", "\uff0d", "\uff20")
"""First characters by which a spreadsheet takes a text for a formula, which a student's name must not become."""


def table_to_csv(table: Table) -> str:
    """The table's numbers in full; an interval takes two columns."""
    spans = [any(isinstance(row[i], tuple) for row in table.rows) for i in range(len(table.columns))]
    out = io.StringIO()
    # All in quotes: where a semicolon separates, "x;=1+1" would be two cells.
    writer = csv.writer(out, lineterminator="\n", quoting=csv.QUOTE_ALL)
    writer.writerow(
        head
        for column, span in zip(table.columns, spans, strict=True)
        for head in ((f"{column.title} low", f"{column.title} high") if span else (column.title,))
    )
    for row in table.rows:
        writer.writerow(
            part for cell, span in zip(row, spans, strict=True) for part in _csv_parts(cell, span=span)
        )
    return out.getvalue()


def _csv_parts(cell: Cell, *, span: bool) -> Iterator[str]:
    if isinstance(cell, tuple):
        yield from map(_csv_text, cell)
    else:
        yield _csv_text(str(cell) if isinstance(cell, ToneText) else cell)
        if span:
            yield ""


def _csv_text(cell: str | float | None) -> str:
    if isinstance(cell, str):
        shown = escape_controls(cell)
        return f"'{shown}" if cell.startswith(_FORMULA) else shown
    return "" if cell is None or not math.isfinite(cell) else repr(cell)


def document_to_json(report: Document) -> str:
    """The whole report as JSON, with null where there is no value."""
    content = {
        "title": report.title,
        "chapters": [
            {"id": each.id, "title": each.title, "blocks": [_block_data(block) for block in each.blocks]}
            for each in report.chapters
        ],
    }
    return json.dumps(content, indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def _block_data(block: Block) -> dict[str, Any]:
    match block:
        case Table():
            return {
                "table": block.id,
                "title": block.title,
                "columns": [column.title for column in block.columns],
                "rows": [[_cell_data(cell) for cell in row] for row in block.rows],
                "note": block.note,
            }
        case Text():
            return {"text": _whole_text(block)}
        case Marked():
            return {"text": block.text}
        case Caution():
            return {"warning": block.text}
        case Quote():
            return {"said": block.text, "by": block.student}
        case BarChart() | Histogram() | ScatterPlot() | ScenePlot():
            return _plot_data(block)
        case _:
            return {"lines": lines_of([block])}


def _plot_data(plot: Plot) -> dict[str, Any]:
    match plot:
        case BarChart():
            rows = [
                {"label": label, "values": [_cell_data(each) for each in values]}
                for label, values in plot.rows
            ]
            return {"bars": plot.id, "title": plot.title, "groups": plot.groups, "rows": rows}
        case Histogram():
            return {"histogram": plot.id, "title": plot.title, "edges": plot.edges, "counts": plot.counts}
        case ScatterPlot():
            return {
                "scatter": plot.id,
                "title": plot.title,
                "x": plot.x,
                "y": plot.y,
                "points": plot.points,
                "line": plot.line,
            }
        case ScenePlot():
            targets = [list(target) for target in plot.scene.targets]
            paths = [{"style": path.style, "points": path.points.tolist()} for path in plot.scene.paths]
            return {"scene": plot.id, "title": plot.title, "targets": targets, "paths": paths}


def _cell_data(cell: Cell) -> Any:
    if isinstance(cell, tuple):
        return list(map(_cell_data, cell))
    if isinstance(cell, ToneText):
        return cell.text
    return None if isinstance(cell, float) and not math.isfinite(cell) else cell


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
nav a { margin-right: 1rem; }
"""


Links = Mapping[str, str]
"""Addresses of other pages, by the code that names each in a text."""


def document_to_html(report: Document, links: Links = MappingProxyType({})) -> str:
    """The whole page. Code that ``links`` knows becomes a link; all links also stand at the top of the page."""
    return "\n".join(_page_lines(report, links)) + "\n"


def _page_lines(report: Document, links: Links) -> Iterator[str]:
    title = _html_text(report.title)
    yield "<!DOCTYPE html>"
    yield '<html lang="en"><head><meta charset="utf-8">'
    yield "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'\">"
    yield '<meta name="viewport" content="width=device-width, initial-scale=1">'
    yield f"<title>{title}</title><style>{_STYLE}</style></head><body>"
    if links:
        others = (f'<a href="{_html_text(to)}">{_html_text(name)}</a>' for name, to in links.items())
        yield f"<nav>{' '.join(others)}</nav>"
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
            yield f"<p>{_html_text(_whole_text(block))}</p>"
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


def _whole_text(block: Text) -> str:
    return f"{block.lead} {block.text}".strip() + block.tail


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
    yield f'<div class="wide"><table>{caption}<thead><tr>'
    yield "".join(
        f'<th scope="col"{kind}>{_html_text(column.title)}</th>'
        for kind, column in zip(kinds, table.columns, strict=True)
    )
    yield "</tr></thead><tbody>"
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
    return escape(printable_text(text))


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
            yield _markdown_text(_whole_text(block))
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
    yield _row(_markdown_text(column.title) for column in table.columns)
    yield _row("---" if column.style is CellStyle.TEXT else "---:" for column in table.columns)
    for number, row in enumerate(table.rows):
        shown = (row[0] if table.shows_first_cell(number) else "", *row[1:])
        yield _row(
            _markdown_text(format_cell(cell, column))
            for cell, column in zip(shown, table.columns, strict=True)
        )
    if table.note:
        yield ""
        yield _markdown_text(table.note)


def _row(cells: Iterator[str]) -> str:
    return f"| {' | '.join(cells)} |"


def _markdown_text(text: str) -> str:
    return printable_text(text).translate(_ESCAPED)
