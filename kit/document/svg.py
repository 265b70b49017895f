"""A document's plots as SVG."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from html import escape
from typing import Final

from kit.document.blocks import (
    BarChart,
    Histogram,
    Plot,
    ScatterPlot,
    ScenePlot,
)
from kit.render.animation_files import svg_picture

WIDTH: Final = 640
MARGIN: Final = 16
LINE: Final = 18
"""Height of a line of text."""

LABEL: Final = 34
"""Characters of one line of a bar's label."""
_SHADES: Final = ("#b9c6d6", "#2f5d8a", "#e8b04a")
_FONT: Final = 'font-family="sans-serif" font-size="12" fill="#222222" stroke="none"'
_AxisScale = Callable[[float], float]
"""From a value to its place on an axis [px]."""


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


def _draw_grid(low: float, high: float, x: _AxisScale, top: float, bottom: float) -> Iterator[str]:
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
