"""The figures beside the world (heading, side panel, messages, what an agent perceives) as rows of text. Pure."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import TYPE_CHECKING, Final

from kit.document.rows import Row, StyledText, row, spread
from kit.geometry import whole_degrees
from kit.plain_text import format_clock, wrap
from kit.run.pacing import MAXIMUM, PacingStatus

if TYPE_CHECKING:
    from kit.learning.policies.agent_view import AgentView, RatedAction
    from kit.ros.log import LogRecord
    from kit.run.view import View


PANEL_WIDTH = 23
SLACK = 0.1
"""The share by which the simulation may miss the speed that was asked for before the heading says so."""

_LOUD: Final = {"WARN": "warn", "ERROR": "bad", "FATAL": "bad"}
"""Styles by a message's severity."""


def heading(view: View, pacing: PacingStatus, width: int, driver: str = "") -> Row:
    """Map and controller on the left; state, speed and time on the right. ``driver``: who drives, where no controller
    does."""
    who = view.controller or driver or "no driver"
    left = row((view.title, "bold"), "  ", who)
    return spread(
        left,
        (*_state(view, pacing), (f"  {format_clock(view.time_s, 2 if view.paused else 1)}", "bold")),
        width,
    )


def _state(view: View, pacing: PacingStatus) -> Row:
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
            _title("pose"),
            _figure("x", _two_decimals(view.pose.x), "m"),
            _figure("y", _two_decimals(view.pose.y), "m"),
            _figure("heading", f"{whole_degrees(view.pose.theta)}", "°"),
            _title("speed"),
            _figure("forward", _two_decimals(view.speed[0]), "m/s"),
            _figure("turning", _two_decimals(view.speed[1]), "rad/s"),
        ]
    if view.nearest:
        rows.append(_title("nearest"))
        rows += [
            _figure(side, "-" if distance is None else f"{distance:.2f}", "m")
            for side, distance in view.nearest
        ]
    score = view.metrics
    rows.append(_title("drive"))
    rows.append(_figure("distance", f"{score.distance_m:.1f}", "m"))
    rows.append(_figure("bumps", f"{score.bumps}", ""))
    if score.reached_s is not None:
        rows.append(row(("target reached", "good")))
        rows.append(_figure("after", f"{score.reached_s:.1f}", "s"))
    elif score.target_m is not None or (view.pose is not None and view.scene.targets):
        # Before the first tick nothing is measured; the row has its place all the same.
        rows.append(_figure("to target", "-" if score.target_m is None else f"{score.target_m:.2f}", "m"))
    if drive is not None:
        rows += [_title("keys"), row(f" {drive}")]
    return tuple(rows)


def _two_decimals(value: float) -> str:
    """Formats with two decimals and without a minus before zero."""
    return f"{round(value, 2) + 0.0:.2f}"


def _title(text: str) -> Row:
    return row((text, "dim"))


def _figure(name: str, value: str, unit: str) -> Row:
    return row(f" {name:<9}", (f"{value:>5}", "bold"), (f" {unit}", "dim"))


def failure_or_messages(view: View, rows: int, width: int) -> tuple[Row, ...]:
    """What went wrong with the controller, in sight as long as it holds; else the newest messages."""
    if view.failure is not None:
        lines = wrap(str(view.failure), width, most=rows)
        return tuple(row((line, "bad")) for line in lines)
    return tuple(message_row(record, width) for record in view.messages[-rows:])


def message_row(record: LogRecord, width: int) -> Row:
    """A message in one row: its time, who says it, its first line as far as it fits."""
    head = f"{format_clock(record.time_ns / 1e9):>7} {record.name}: "
    text: StyledText = (
        record.text.partition("\n")[0][: max(0, width - len(head))],
        _LOUD.get(record.severity.name, ""),
    )
    return row((head, "dim"), text)


LARGE_SIZE: Final = (120, 36)
"""Columns and rows from which on a screen has room for instruments."""
LARGE_PANEL_WIDTH: Final = 46
WIDE_PANEL: Final = (160, 60)
"""From so many columns on the panel is so wide."""

CHART_ROWS: Final = 5
HISTORY_S: Final = 60.0
SAMPLE_S: Final = 0.2
"""Seconds of the simulation that the charts of the past cover, and between two of their points."""

_EIGHTHS: Final = " ▁▂▃▄▅▆▇█"


def panel_width(columns: int) -> int:
    """Returns the width of the panel of a large screen."""
    return WIDE_PANEL[1] if columns >= WIDE_PANEL[0] else LARGE_PANEL_WIDTH


@dataclass
class SpeedHistory:
    """The robot's speeds of the last minute."""

    forward_speeds: deque[float] = field(default_factory=lambda: deque(maxlen=round(HISTORY_S / SAMPLE_S)))
    turning: deque[float] = field(default_factory=lambda: deque(maxlen=round(HISTORY_S / SAMPLE_S)))
    _last: float = -math.inf

    def add(self, view: View) -> None:
        """Notes the view's speeds, every ``SAMPLE_S``; starts again where the clock went back."""
        if view.time_s < self._last:
            self.forward_speeds.clear()
            self.turning.clear()
            self._last = -math.inf
        # Several samples at once where the simulation runs ahead of the screen: the chart's axis is time.
        missed = 1 if self._last == -math.inf else int((view.time_s - self._last) / SAMPLE_S + 1e-6)
        for _ in range(min(missed, self.forward_speeds.maxlen or 0)):
            self.forward_speeds.append(view.speed[0])
            self.turning.append(view.speed[1])
        if missed:
            self._last = view.time_s if self._last == -math.inf else self._last + missed * SAMPLE_S


def instruments(
    view: View, history: SpeedHistory, drive: str | None, program: Sequence[str], size: tuple[int, int]
) -> tuple[Row, ...]:
    """The panel of a large screen, in order of importance as far as ``size``, columns and rows, has room.

    ``program``: the lines of the controller's file.
    """
    width, height = size
    rows: list[Row] = [title("robot", width), *_two_columns(readout(view, drive), width)]
    ranges = view.laser.tolist()
    if any(map(math.isfinite, ranges)):
        rows += [
            title("laser", width, "distance to the left, ahead, to the right"),
            *laser_chart(ranges, width),
        ]
    if history.forward_speeds:
        rows += [
            title("speed", width, f"last {HISTORY_S:.0f} s, m/s"),
            *time_chart(history.forward_speeds, width, 0.1),
        ]
        rows += [title("turning", width, "rad/s, up is left"), *time_chart(history.turning, width, 0.5)]
    left = height - len(rows)
    if view.messages and left > 2:
        shown = view.messages[-max(1, min(len(view.messages), 8, left - 1)) :]
        rows += [title("messages", width), *(message_row(record, width) for record in shown)]
    left = height - len(rows)
    if program and left > 3:
        rows += [
            title(view.controller or "program", width, "^E edits it"),
            *_code_rows(program, width, left - 1),
        ]
    return tuple(rows[:height])


def title(name: str, width: int, note: str = "") -> Row:
    """A quiet rule with a name on it."""
    text = f" {name} "
    note = f" {note} " if note and len(text) + len(note) + 8 <= width else ""
    rule = "─" * max(0, width - 2 - len(text) - len(note) - (1 if note else 0))
    return row(("──", "dim"), (text, "bold"), (rule, "dim"), (note, "dim"), ("─" if note else "", "dim"))


def _two_columns(rows: Sequence[Row], width: int) -> list[Row]:
    """The same rows in two columns, the second from a title on."""
    titles = [
        number for number, parts in enumerate(rows) if len(parts) == 1 and not parts[0][0].startswith(" ")
    ]
    middle = min(titles, key=lambda number: abs(number - len(rows) / 2), default=0)
    left, right = rows[:middle], rows[middle:]
    half = width // 2
    joined = []
    for number in range(max(len(left), len(right))):
        first = left[number] if number < len(left) else ()
        used = sum(len(text) for text, _ in first)
        second = right[number] if number < len(right) else ()
        joined.append((*first, (" " * max(1, half - used), ""), *second))
    return joined


def laser_chart(laser: Sequence[float], width: int, rows: int = CHART_ROWS) -> list[Row]:
    """Bars of the distance [m] by direction, from behind on the left over ahead in the middle to behind on the right."""
    ranges = laser[::-1]
    bars = width - 6
    columns = (bar * len(ranges) // bars for bar in range(bars + 1))
    heights = []
    for start, stop in pairwise(columns):
        seen = filter(math.isfinite, ranges[start : max(stop, start + 1)])
        heights.append(min(seen, default=0.0))
    return _bars(heights, max(heights, default=0.0) or 1.0, rows, "m")


def time_chart(values: Sequence[float], width: int, least: float, rows: int = CHART_ROWS) -> list[Row]:
    """The newest values on the right, from the middle row up and down where some are negative."""
    room = width - 6
    shown = list(values)[-room * 2 :]
    # Two samples to a character where there are many.
    paired = [max(shown[i : i + 2], key=abs) for i in range(0, len(shown), 2)] if len(shown) > room else shown
    paired = [0.0] * (room - len(paired)) + paired[-room:]
    largest = max((abs(value) for value in paired), default=0.0)
    top = max(least, math.ceil(largest / least - 1e-9) * least)
    if min(paired, default=0.0) > -0.05 * top:
        return _bars(paired, top, rows, "")
    middle = rows // 2
    upper = _bars([max(value, 0.0) for value in paired], top, middle, "", has_zero=False)
    lower = [
        row(
            (f"{-top:4.1f}  " if number == rows - middle - 2 else " " * 6, "dim"),
            ("".join(_downward(-value / top * (rows - middle - 1) - number) for value in paired), "code"),
        )
        for number in range(rows - middle - 1)
    ]
    axis = row(("   0  ", "dim"), ("".join("─" if value == 0.0 else "━" for value in paired), "dim"))
    return [*upper, axis, *lower]


def _downward(share: float) -> str:
    """A character filled from its top: half and whole are all there are."""
    return "█" if share >= 0.75 else "▀" if share >= 0.1 else " "


def column_chart(shares: Sequence[float], rows: int) -> list[str]:
    """A column for each share, 0 to 1 of the height, as ``rows`` lines of text."""
    return [
        "".join(_EIGHTHS[min(8, max(0, round((share * rows - line) * 8)))] for share in shares)
        for line in range(rows - 1, -1, -1)
    ]


def _bars(values: Sequence[float], top: float, rows: int, unit: str, *, has_zero: bool = True) -> list[Row]:
    lines = []
    for number, glyphs in enumerate(column_chart([value / top for value in values], rows)):
        label = " " * 6
        if number == 0:
            label = f"{top:4.1f}{unit:<2}"
        elif number == rows - 1 and has_zero:
            label = f"   0{unit:<2}"
        lines.append(row((label, "dim"), (glyphs, "code")))
    return lines


def _code_rows(program: Sequence[str], width: int, rows: int) -> list[Row]:
    """The program from its first class or function on, or its beginning."""
    first = next((number for number, line in enumerate(program) if line.startswith(("class ", "def "))), 0)
    start = max(0, min(first, len(program) - rows))
    return [
        row((f"{start + number + 1:3d} ", "dim"), line.expandtabs(4)[: max(0, width - 4)])
        for number, line in enumerate(program[start : start + rows])
    ]


AGENT_WIDTH: Final = 30
RATING_WIDTH: Final = 7
SHARE_ROWS: Final = 2
"""Rows of the chart of the expected return."""


def agent_panel(
    view: AgentView, about: tuple[tuple[str, str], ...], width: int, height: int
) -> tuple[Row, ...]:
    """The panel of at most ``height`` rows: who drives where, a bar for every action, what is perceived.

    ``about``: names and values above the bars, such as agent, environment and return. Where there are more actions than
    room, the ones rated highest are shown.
    """
    head = [
        row((f"{name} ", "dim"), (value[: max(1, width - len(name) - 1)], "bold")) for name, value in about
    ]
    readings = [
        _reading("nearest" if len(view.nearest) == 1 else f"nearest {robot + 1}", distance, " m")
        for robot, distance in enumerate(view.nearest)
        if math.isfinite(distance)
    ]
    readings += [_reading(name.replace("_", " "), value, "") for name, value in view.readings]
    below = [row(("perceives", "dim")), *readings] if readings else []
    expected = _expected_rows(view.expected_returns, width)
    if height - len(head) - 1 - len(below) - len(expected) < min(4, len(view.actions)):
        expected = expected[:1]  # the newest value alone
    below = [*expected, *below]
    room = max(3, height - len(head) - 1 - len(below))
    shown = view.actions
    if len(shown) > room:
        kept = sorted(shown, key=lambda action: (not action.is_chosen, -action.rating))[: room - 1]
        shown = tuple(action for action in view.actions if action in kept)
    bars = [_bar(action, view.kind, width) for action in shown]
    if len(shown) < len(view.actions):
        bars.append(row((f" {len(view.actions) - len(shown)} more", "dim")))
    return (*head, row((_TITLES[view.kind], "dim")), *bars, *below)[:height]


def _expected_rows(values: Sequence[float], width: int) -> list[Row]:
    """The return that the agent expects from here on, and a chart of what it expected at each step so far."""
    if not values:
        return []
    import numpy as np  # of no use to the first frame

    parts = np.array_split(np.array(values), min(max(1, width - 1), len(values)))
    means = [float(part.mean()) for part in parts]
    low, high = min(0.0, *means), max(0.0, *means)
    shares = [(mean - low) / max(high - low, 1e-9) for mean in means]
    return [
        row(("expects ", "dim"), (f"{values[-1]:.2f}", "bold"), (f" ({low:.1f} to {high:.1f})", "dim")),
        *(row((f" {glyphs}", "code")) for glyphs in column_chart(shares, SHARE_ROWS)),
    ]


_TITLES: Final = {
    "probability": "probability of each action",
    "value": "value of each action",
    "command": "command",
}


def _bar(action: RatedAction, kind: str, width: int) -> Row:
    rating = f"{action.rating:.0%}" if kind == "probability" else f"{action.rating:.2f}"
    room = max(0, width - RATING_WIDTH - 1)
    name_width = min(14, room // 2)
    bar_width = max(0, room - name_width - 1)
    length = round(min(max(action.share, 0.0), 1.0) * bar_width)
    style = "bold" if action.is_chosen else ""
    mark = "▶" if action.is_chosen else " "
    return row(
        (f"{mark}{action.name:{name_width}.{name_width}} ", style),
        ("█" * length + " " * (bar_width - length), style),
        (f"{rating:>{RATING_WIDTH}}", style),
    )


def _reading(name: str, value: float, unit: str) -> Row:
    return row(f" {name:<15.15}", (f"{round(value, 2) + 0.0:>8.2f}", "bold"), (unit, "dim"))
