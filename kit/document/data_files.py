"""A document for machines: its tables as CSV, all of it as JSON."""

from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Iterator
from typing import Any

from kit.document.blocks import (
    BarChart,
    Block,
    Caution,
    Cell,
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
)
from kit.document.layout import lines_of
from kit.plain_text import escape_controls, without_formula


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
        return escape_controls(without_formula(cell))
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
            return {"text": block.whole_text}
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
