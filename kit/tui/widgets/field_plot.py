"""A plot of one field of a topic's last messages over time, and which field of a message can be plotted."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np
from textual.app import ComposeResult
from textual.containers import Vertical

from kit.document.rows import Row, row
from kit.msg.conversion import FieldValue, number_at
from kit.render.curve import Axes, Curve, nice_ceiling
from kit.ros.graph.topic_statistics import FieldSample
from kit.tui.theme import Theme
from kit.tui.widgets.chart_view import CurveView
from kit.tui.widgets.text_rows import TextRows

LARGEST: Final = 1e300
"""What is further from 0 counts as not finite: the scale of the plot could not hold it."""


def first_field(fields: Sequence[str], values: Mapping[str, FieldValue]) -> str:
    """The field to choose first: one with a number that is not the header's; empty where there is no field."""
    numbers = [field for field in fields if field in values]
    own = [field for field in numbers if not field.startswith("header.")]
    return next(iter((*own, *numbers, *fields)), "")


def item_count(values: Mapping[str, FieldValue], field: str) -> int:
    """How many items of the field can be plotted; 0 where it is a single number or a text."""
    value = values.get(field)
    return 0 if value is None or isinstance(value, (float, int)) else len(value)


def why_not(values: Mapping[str, FieldValue], field: str) -> str:
    """Why a field cannot be plotted; empty if it can."""
    if field not in values:
        return f"{field} is not a number: it cannot be plotted"
    if not isinstance(values[field], (float, int)) and not item_count(values, field):
        return f"{field} is empty: there is nothing to plot"
    return ""


def field_curve(path: str, history: Sequence[FieldSample]) -> Curve:
    """The numbers at a path over time [s], the newest message at 0; a gap where a number is not finite."""
    found = [(sample.time_ns, number_at(sample.values, path)) for sample in history]
    kept = [(time_ns, number) for time_ns, number in found if number is not None]
    seconds = np.array([(time_ns - kept[-1][0]) / 1e9 for time_ns, _ in kept], dtype=np.float64)
    numbers = np.array([number for _, number in kept], dtype=np.float64)
    numbers[~(np.abs(numbers) < LARGEST)] = np.nan
    return Curve(path, seconds, numbers, has_gaps=True)


def plot_note(curve: Curve) -> Row:
    """How many messages a curve shows, and how many of them have no finite value."""
    count, gaps = len(curve.y), int(np.isnan(curve.y).sum())
    words = "the last message" if count == 1 else f"the last {count} messages"
    if gaps == count:
        return row((f"{words}: no finite value", "warn"))
    return row((words, "dim"), (f", {gaps} of them not finite: gaps" if gaps else "", "warn"))


class FieldPlot(Vertical):
    """Shows a field of the last messages as a curve: its path as the title, its values on the left, seconds below."""

    DEFAULT_CSS = """
    FieldPlot { height: 1fr; }
    FieldPlot #note { height: 1; }
    FieldPlot CurveView { height: 1fr; }
    """

    def __init__(self, theme: Theme, *, id: str | None = None) -> None:  # noqa: A002 - Textual's own name
        super().__init__(id=id)
        self._note = TextRows(id="note")
        self._curve = CurveView(encoder=theme.encoder, palette=theme.palette)

    def compose(self) -> ComposeResult:
        yield self._curve
        yield self._note

    def show(self, path: str, history: Sequence[FieldSample]) -> None:
        """Plots the number at a path of ``field_values`` in these messages."""
        curve = field_curve(path, history)
        start = -nice_ceiling(-float(curve.x[0])) if len(curve.x) else -1.0
        self._curve.display = True
        self._curve.show([curve], Axes("s", start=start, end=0.0))
        self._note.show([plot_note(curve)])

    def show_reason(self, reason: str) -> None:
        """No plot, but why there is none."""
        self._curve.display = False
        self._note.show([row((reason, "warn"))])
