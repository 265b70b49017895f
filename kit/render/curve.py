"""Learning curves in characters: lines of dots, their scale on the left, their length below.

The scale keeps to round numbers, so it moves seldom: a curve grows to the right instead of shrinking.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from kit.arrays import FloatArray
from kit.render import raster
from kit.render.encode import Encoder, Frame, GlyphSet
from kit.render.frame_text import paste_frame, write_text
from kit.render.role_looks import LINE_DASHES, LineStyle
from kit.render.roles import CURVE_ROLES, Role


class CurveStyle(NamedTuple):
    """How a curve is drawn where there are several."""

    line: LineStyle
    mark: str
    """Mark in the legend."""
    ascii_mark: str


CURVE_STYLES = (
    CurveStyle("solid", "━", "="),
    CurveStyle("long-dashed", "╍", "-"),
    CurveStyle("dotted", "┈", "."),
    CurveStyle("paired", "┉", ":"),
)
"""The first curve's, the second's, ..., the fifth's as the first's again."""

NUMBER_COLUMNS = 24
"""Columns between two numbers of one curve on its line."""

ROWS_PER_TICK = 4
"""Rows of a plot for each value between the ends of its scale."""

MIN_COLUMNS_WITH_MARGIN = 20
"""From this many columns on, there is room for a scale on the left."""


@dataclass(frozen=True, slots=True, eq=False)
class Curve:
    """A quantity over a course of steps, episodes or seconds. Values that are not finite leave a gap in the data;
    in the line too where it ``has_gaps``."""

    name: str
    x: FloatArray
    """(n,), rising."""
    y: FloatArray
    """(n,)"""
    has_gaps: bool = False
    """Whether the line is broken where a value is not finite."""


@dataclass(frozen=True, slots=True)
class Axes:
    """Unit, range and goal of the axes."""

    unit: str = ""
    """Unit of the horizontal axis, such as ``steps``."""
    low: float | None = None
    """The least value shown; by default a round number below the data's."""
    high: float | None = None
    goal: float | None = None
    """A level to reach, drawn as a dashed line."""
    start: float = 0.0
    """The least x shown."""
    end: float | None = None
    """The greatest one; by default a round number beyond the data's."""
    margin: int = 0
    """Columns on the left at least, for plots one below the other."""


def draw_curves(curves: Sequence[Curve], axes: Axes, columns: int, rows: int, encoder: Encoder) -> Frame:
    """A frame of ``columns`` x ``rows`` characters: names and newest values on top, then the plot, then the
    horizontal scale. Where there is little room the plot keeps it."""
    frame = Frame.empty(columns, rows)
    drawn, curves = curves, [_without_gaps(curve) for curve in curves]
    low, high = _value_range(curves, axes)
    right = axes.end
    if right is None:
        right = nice_ceiling(max((float(curve.x[-1]) for curve in curves if len(curve.x)), default=1.0))
    drawn = [replace(curve, x=curve.x - axes.start) for curve in drawn]
    top, bottom = int(rows >= 4), rows - int(rows >= 3)
    labels = dict(zip((top, bottom - 1), _scale_labels(high, low), strict=True))
    if axes.goal is not None:
        labels.setdefault(top + _row_of(axes.goal, low, high, bottom - top), f"{axes.goal:.4g}")
    for value in _ticks_between(low, high, (bottom - top) // ROWS_PER_TICK):
        row = top + _row_of(value, low, high, bottom - top)
        label = f"{value:.4g}"
        if label not in labels.values() and not labels.keys() & {row - 1, row, row + 1}:
            labels[row] = label
    left = max(axes.margin, max(map(len, labels.values())) + 1) if columns >= MIN_COLUMNS_WITH_MARGIN else 0
    plot = _draw_plot(
        drawn, axes.goal, (low, high, right - axes.start), columns - left, bottom - top, encoder
    )
    paste_frame(frame, plot, top, left)
    if left:
        draw_value_axis(frame, range(top, bottom), labels, left, encoder.symbols)
        if bottom < rows:
            *_, corner, level = encoder.symbols.axes
            write_text(frame, bottom, left - 1, corner + level * (columns - left))
    if bottom < rows:
        write_text(frame, bottom, left, f"{axes.start:.4g} ")
        end = f" {_format_count(right)} {axes.unit}".rstrip()
        write_text(frame, bottom, max(left + 2, columns - len(end)), end)
    if top:
        _write_names(frame, curves, left, is_ascii=bool(encoder.symbols.heading_strokes))
    return frame


def _draw_plot(
    curves: Sequence[Curve],
    goal: float | None,
    scale: tuple[float, float, float],
    columns: int,
    rows: int,
    encoder: Encoder,
) -> Frame:
    """The lines alone, from x = 0 on; ``scale``: least and greatest value, greatest x."""
    columns, rows = max(1, columns), max(1, rows)
    low, high, right = scale
    width, height = columns * encoder.across, rows * encoder.down
    grid = raster.empty_grid(width, height)

    def level(values: FloatArray) -> FloatArray:
        dots: FloatArray = (high - values) / (high - low) * (height - 1) + 0.5
        return dots

    if goal is not None:
        y = float(level(np.array(goal)))
        line, across = raster.line_dots(np.array([(0.0, y, width - 0.5, y)]), width, height)
        kept = across % 6 < 3
        raster.draw_dots(grid, (line[kept], across[kept]), Role.PATH)
    for number, curve in enumerate(curves):
        role = CURVE_ROLES[number % len(CURVE_ROLES)]
        period, drawn = LINE_DASHES[CURVE_STYLES[number % len(CURVE_STYLES)].line]
        for part in _line_parts(curve):
            x, y_mean = _bin_means(part, right, width)
            dots = np.stack((x, level(y_mean)), axis=1)
            raster.draw_dots(grid, raster.point_dots(dots, width, height), role)
            rows_drawn, columns_drawn = raster.line_dots(raster.polyline(dots), width, height)
            kept = np.arange(len(rows_drawn)) % period < drawn
            raster.draw_dots(grid, (rows_drawn[kept], columns_drawn[kept]), role)
    frame = encoder.encode(grid)
    if len(curves) > 1:
        for number, curve in enumerate(map(_without_gaps, curves)):
            for column, value in _number_places(curve, number, right, columns):
                row = math.floor(level(np.array(value)) / encoder.down)
                if 0 <= row < rows:
                    write_text(frame, row, column, str(number + 1), CURVE_ROLES[number % len(CURVE_ROLES)])
    return frame


def _number_places(curve: Curve, number: int, right: float, columns: int) -> Iterator[tuple[int, float]]:
    """Where the number of a curve stands on its line, columns and values: now and then, each curve's in other columns so
    that one that hides another does not hide its number, and at its end."""
    if not len(curve.x):
        return
    end = int(curve.x[-1] / right * (columns - 1))
    middles, means = _bin_means(curve, right, columns)
    first = NUMBER_COLUMNS * (2 * number + 1) // (2 * len(CURVE_ROLES))
    for middle, mean in zip(middles.tolist(), means.tolist(), strict=True):
        if int(middle) % NUMBER_COLUMNS == first % NUMBER_COLUMNS and middle < end - 2:
            yield int(middle), mean
    yield end, float(curve.y[-1])


def _ticks_between(low: float, high: float, most: int) -> list[float]:
    """Round values between the ends of a scale, at most this many."""
    if most < 1:
        return []
    step = nice_ceiling((high - low) / (most + 1))
    first, last = math.floor(low / step) + 1, math.ceil(high / step) - 1
    return [step * number for number in range(first, min(last, first + most) + 1)]


def _row_of(value: float, low: float, high: float, rows: int) -> int:
    return math.floor((high - value) / (high - low) * (rows - 1) + 0.5)


def _bin_means(curve: Curve, right: float, bins: int) -> tuple[FloatArray, FloatArray]:
    """The middles [dots] of the columns of dots that have data, and the mean of the data in each."""
    if not len(curve.x):
        return np.empty(0), np.empty(0)
    which = np.clip(curve.x / right * bins, 0, bins - 1).astype(np.intp)
    count = np.bincount(which, minlength=bins)
    total = np.bincount(which, weights=curve.y, minlength=bins)
    kept = np.flatnonzero(count)
    return kept.astype(np.float64) + 0.5, np.asarray(total[kept] / count[kept], dtype=np.float64)


def _without_gaps(curve: Curve) -> Curve:
    kept = np.isfinite(curve.x) & np.isfinite(curve.y)
    return Curve(curve.name, curve.x[kept], curve.y[kept])


def _line_parts(curve: Curve) -> list[Curve]:
    """The pieces of a curve that are each drawn as one line."""
    if not curve.has_gaps:
        return [_without_gaps(curve)]
    gaps = np.flatnonzero(~(np.isfinite(curve.x) & np.isfinite(curve.y)))
    pieces = zip(np.split(curve.x, gaps), np.split(curve.y, gaps), strict=True)
    return [_without_gaps(Curve(curve.name, x, y)) for x, y in pieces]


def _scale_labels(high: float, low: float) -> tuple[str, str]:
    """The two values in as few digits, four at least, as tell them apart."""
    labels = ((f"{high:.{digits}g}", f"{low:.{digits}g}") for digits in range(4, 18))
    return next((pair for pair in labels if pair[0] != pair[1]), (f"{high}", f"{low}"))


def _value_range(curves: Sequence[Curve], axes: Axes) -> tuple[float, float]:
    """Least and greatest value shown, always different."""
    seen = [curve.y for curve in curves if len(curve.y)]
    values = np.concatenate(seen) if seen else np.array((0.0, 1.0))
    marks = [float(values.min()), float(values.max())] + ([] if axes.goal is None else [axes.goal])
    low, high = min(marks), max(marks)
    finest = 4 * float(np.spacing(max(abs(low), abs(high))))  # nearer values than that are one
    step = nice_ceiling(max((high - low) / 4, finest) if high > low else abs(high) or 1.0)
    low = math.floor(low / step) * step if axes.low is None else axes.low
    high = math.ceil(high / step) * step if axes.high is None else axes.high
    return (low, high) if high > low else (low, low + step)


def nice_ceiling(value: float) -> float:
    """The next of 1, 2, 5, 10, 20, 50, ... times any power of ten; 1 for what is next to nothing."""
    if value < 1e-300:
        return 1.0
    power = 10.0 ** math.floor(math.log10(value))
    return next(factor * power for factor in (1.0, 2.0, 5.0, 10.0) if value <= factor * power * (1 + 1e-9))


def _format_count(value: float) -> str:
    """A round number as people write it: 50,000, or 0.2."""
    return f"{value:,.0f}" if value >= 1 else f"{value:.4g}"


def draw_value_axis(
    frame: Frame, rows: Iterable[int], labels: Mapping[int, str], left: int, symbols: GlyphSet
) -> None:
    """The upright axis in the last of ``left`` columns, and its labels by row."""
    upright, tick, *_ = symbols.axes
    for row in rows:
        label = labels.get(row, "")
        write_text(frame, row, 0, label.rjust(left - 1) + (tick if label else upright))


def _write_names(frame: Frame, curves: Sequence[Curve], column: int, *, is_ascii: bool) -> None:
    for number, curve in enumerate(curves):
        newest = f" {curve.y[-1]:.3g}" if len(curve.y) else ""
        style = CURVE_STYLES[number % len(CURVE_STYLES)]
        key = f"{style.ascii_mark if is_ascii else style.mark}{number + 1} " if len(curves) > 1 else ""
        text = f"{key}{curve.name}{newest}"
        write_text(frame, 0, column, text, CURVE_ROLES[number % len(CURVE_ROLES)])
        column += len(text) + 1
