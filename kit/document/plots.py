"""Plots in characters, 79 columns wide: bars, histograms, points and maps, which need no colour and, if asked, nothing but ASCII."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Final

from kit.document.blocks import BarChart, Histogram, Plot, ScatterPlot, ScenePlot
from kit.document.glyphs import BLOCK_GLYPHS, WIDTH, PlotGlyphs
from kit.plain_text import printable_line, wrap

BAR_WIDTH: Final = 40
SCATTER_SIZE: Final = (56, 15)
"""Columns and rows of the field in which points are drawn."""
SCENE_ROWS: Final = 18
"""Most rows of a map."""


def plot_lines(plot: Plot, glyphs: PlotGlyphs = BLOCK_GLYPHS) -> Iterator[str]:
    """The title of a plot, and the plot."""
    yield from wrap(printable_line(plot.title), WIDTH)
    match plot:
        case BarChart():
            yield from _bar_lines(plot, glyphs)
        case Histogram():
            yield from _histogram_lines(plot, glyphs)
        case ScatterPlot():
            yield from _scatter_lines(plot, glyphs)
        case ScenePlot():
            yield from _scene_lines(plot, glyphs)


def _bar_lines(bars: BarChart, glyphs: PlotGlyphs) -> Iterator[str]:
    groups = max(map(len, bars.groups))
    labels = min(max((len(label) for label, _ in bars.rows), default=0), WIDTH - BAR_WIDTH - groups - 11)
    indent = " " * (labels + groups + 3)
    yield f"{indent}{bars.low:<{BAR_WIDTH // 2}g}{bars.high:>{BAR_WIDTH - BAR_WIDTH // 2}g}"
    for label, values in bars.rows:
        text = wrap(printable_line(label), labels)
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
    labels = [f"{low:g} to {high:g}" for low, high in zip(histogram.edges, histogram.edges[1:], strict=False)]
    width = max(map(len, labels))
    most = max((*histogram.counts, 1))
    unit = max(1, -(-most // BAR_WIDTH))
    scale = 2 if 2 * most <= BAR_WIDTH else 1
    for label, count in zip(labels, histogram.counts, strict=True):
        yield f"{label:>{width}} |{glyphs.bars[0] * round(count / unit * scale)} {count}"


def _scatter_lines(scatter: ScatterPlot, glyphs: PlotGlyphs) -> Iterator[str]:
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
        for number in range(columns):
            x = left + (right - left) * number / (columns - 1)
            y = slope * x + height
            if low <= y <= high:
                row, column = place(x, y)
                field[row][column] = glyphs.line
    seen: dict[tuple[int, int], int] = {}
    for x, y in scatter.points:
        seen[place(x, y)] = seen.get(place(x, y), 0) + 1
    for (row, column), count in seen.items():
        field[row][column] = glyphs.point if count == 1 else str(count) if count < 10 else "+"
    yield f"{printable_line(scatter.y)} (up) by {printable_line(scatter.x)} (right)"
    margin = max(len(f"{low:g}"), len(f"{high:g}"))
    for number, dots in enumerate(field):
        label = {0: f"{high:g}", rows - 1: f"{low:g}"}.get(number, "")
        yield f"{label:>{margin}} |{''.join(dots)}".rstrip()
    yield f"{'':>{margin}} +{'-' * columns}"
    yield f"{'':>{margin}}  {left:<{columns // 2}g}{right:>{columns - columns // 2}g}"
    trend = f"; {glyphs.line} the trend" if scatter.line is not None else ""
    yield f"{'':>{margin}}  {glyphs.point} one student, a digit several{trend}"


def _scene_lines(plot: ScenePlot, glyphs: PlotGlyphs) -> Iterator[str]:
    from kit.render.encode import ENCODERS  # in here, with numpy: most texts hold no map
    from kit.render.world_text import scene_rows

    rows = scene_rows(plot.scene, WIDTH, SCENE_ROWS, ENCODERS[glyphs.encoder](True))
    yield from (row.rstrip() for row in rows if row.strip())
