"""The figures beside the world (heading, side panel, messages) as rows of text."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from kit.document.rows import Row, StyledText, at_both_edges, row, row_width
from kit.geometry import whole_degrees
from kit.plain_text import format_clock, wrap
from kit.run.pacing import MAXIMUM, PacingStatus

if TYPE_CHECKING:
    from kit.ros.log import LogRecord
    from kit.run.view import View


PANEL_WIDTH = 23
LEAST_BAR, LONGEST_BAR = 10, 60
"""Columns of the bar of what is replayed."""
SLACK = 0.1
"""The share by which the simulation may miss the speed that was asked for before the heading says so."""

_LOUD: Final = {"WARN": "warn", "ERROR": "bad", "FATAL": "bad"}
"""Styles by a message's severity."""


def heading(
    view: View, pacing: PacingStatus, width: int, driver: str = "", length_s: float | None = None
) -> Row:
    """Map and controller on the left; state, speed and time on the right. ``driver``: who drives, where no controller
    does. ``length_s``: of what is replayed, of which a bar shows how far it has come [s]."""
    who = view.controller or driver or "no driver"
    left = row((view.title, "title"), "  ", who)
    clock = format_clock(view.time_s, 2 if view.paused else 1)
    right = row(*_state_row(view, pacing), (f"  {clock}", "bold"))
    if length_s:
        right = (*right, (f" of {format_clock(length_s, 1)}", "dim"))
        room = min(width - row_width(left) - row_width(right) - 4, LONGEST_BAR)
        if room >= LEAST_BAR:
            filled = round(room * min(view.time_s / length_s, 1.0))
            right = (("━" * filled, "good"), ("─" * (room - filled), "dim"), ("  ", ""), *right)
    return at_both_edges(left, right, width)


def _state_row(view: View, pacing: PacingStatus) -> Row:
    if view.paused:
        return row(("paused", "warn"))
    asked, actual = pacing.factor, pacing.actual_factor
    if asked == MAXIMUM:
        return row("speed max", (f" (x{actual:.0f})" if actual else "", "dim"))
    # What it reaches is news only where it is not what was asked for.
    behind = f" (reaches x{actual:.1f})" if actual and abs(actual / asked - 1.0) > SLACK else ""
    return row(f"speed x{asked:g}", (behind, "dim"))


def readout(view: View, drive: str | None) -> tuple[Row, ...]:
    """The side panel, at most 20 rows of 21 characters."""
    rows: list[Row] = []
    if view.pose is not None:
        rows += [
            _title_row("pose"),
            _figure_row("x", _two_decimals(view.pose.x), "m"),
            _figure_row("y", _two_decimals(view.pose.y), "m"),
            _figure_row("heading", f"{whole_degrees(view.pose.theta)}", "°"),
            _title_row("speed"),
            _figure_row("forward", _two_decimals(view.speed[0]), "m/s"),
            _figure_row("turning", _two_decimals(view.speed[1]), "rad/s"),
        ]
    if view.nearest:
        rows.append(_title_row("nearest"))
        rows += [
            _figure_row(side, "-" if distance is None else f"{distance:.2f}", "m")
            for side, distance in view.nearest
        ]
    score = view.metrics
    rows.append(_title_row("drive"))
    rows.append(_figure_row("distance", f"{score.distance_m:.1f}", "m"))
    rows.append(_figure_row("bumps", f"{score.bumps}", ""))
    if score.reached_s is not None:
        rows.append(row(("target reached", "good")))
        rows.append(_figure_row("after", f"{score.reached_s:.1f}", "s"))
    elif score.target_m is not None or (view.pose is not None and view.scene.targets):
        # Before the first tick nothing is measured; the row has its place all the same.
        rows.append(_figure_row("to target", "-" if score.target_m is None else f"{score.target_m:.2f}", "m"))
    if drive is not None:
        rows += [_title_row("key mode (z)"), row(f" {drive}")]
    return tuple(rows)


def _two_decimals(value: float) -> str:
    """Formats with two decimals and without a minus before zero."""
    return f"{round(value, 2) + 0.0:.2f}"


def _title_row(text: str) -> Row:
    return row((text, "title"))


def _figure_row(name: str, value: str, unit: str) -> Row:
    return row(f" {name:<9}", (f"{value:>5}", "bold"), (f" {unit}", "dim"))


TOGETHER_NS: Final = 1_000_000_000
"""Messages that come within such a time are read together [ns, simulated]."""


def failure_or_messages(view: View, rows: int, width: int) -> tuple[Row, ...]:
    """What went wrong with the controller, in sight as long as it holds; else the newest messages."""
    if view.failure is not None:
        lines = wrap(str(view.failure), width, most=rows)
        return tuple(row((line, "bad")) for line in lines)
    records = view.messages[-rows:]
    together = [each for each in records if records[-1].time_ns - each.time_ns < TOGETHER_NS]
    most = rows - max(
        0, len(together) - 1
    )  # the newest one has as many rows as it needs, but hides none that came with it
    shown: tuple[Row, ...] = ()
    for record in reversed(records):
        if len(shown) < rows:
            shown = (*message_rows(record, width, 1 if shown else most), *shown)
    return shown


def _cut(line: str, width: int) -> str:
    """As much of a line as fits; dots where that ends in the middle of a word."""
    is_within_word = len(line) > width > 0 and line[width - 1].isalnum() and line[width].isalnum()
    return f"{line[: width - 1]}…" if is_within_word else line[:width]


def message_rows(record: LogRecord, width: int, most: int = 1) -> list[Row]:
    """A message in at most this many rows: its time, who says it, its first line as far as it fits."""
    clock = f"{format_clock(record.time_ns / 1e9):>7} "
    head = f"{clock}{record.name}: "
    text = record.text.partition("\n")[0]
    style = _LOUD.get(record.severity.name, "")
    line = head + text
    if len(line) <= width or most == 1:
        lines = [_cut(line, width)]
    else:
        lines = wrap(text, width, head, " " * len(clock), most=most)
    first: StyledText = (lines[0][len(head) :], style)
    return [row((lines[0][: len(head)], "dim"), first), *(row((line, style)) for line in lines[1:])]
