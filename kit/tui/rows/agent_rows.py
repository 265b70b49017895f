"""What an agent that drives perceives, rates and expects, as rows of text."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

from kit.document.rows import Row, row
from kit.tui.rows.chart_rows import column_chart

if TYPE_CHECKING:
    from kit.learning.policies.agent_view import AgentView, RatedAction


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
        _reading_row("nearest" if len(view.nearest) == 1 else f"nearest {robot + 1}", distance, " m")
        for robot, distance in enumerate(view.nearest)
        if math.isfinite(distance)
    ]
    readings += [_reading_row(name.replace("_", " "), value, "") for name, value in view.readings]
    below = [row(("perceives", "title")), *readings] if readings else []
    expected = _expected_rows(view.expected_returns, width)
    if height - len(head) - 1 - len(below) - len(expected) < min(4, len(view.actions)):
        expected = expected[:1]  # the newest value alone
    below = [*expected, *below]
    room = max(3, height - len(head) - 1 - len(below))
    shown = view.actions
    if len(shown) > room:
        kept = sorted(shown, key=lambda action: (not action.is_chosen, -action.rating))[: room - 1]
        shown = tuple(action for action in view.actions if action in kept)
    bars = [_action_bar(action, view.kind, width) for action in shown]
    if len(shown) < len(view.actions):
        bars.append(row((f" {len(view.actions) - len(shown)} more", "dim")))
    return (*head, row((_TITLES[view.kind], "title")), *bars, *below)[:height]


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


def _action_bar(action: RatedAction, kind: str, width: int) -> Row:
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


def _reading_row(name: str, value: float, unit: str) -> Row:
    return row(f" {name:<15.15}", (f"{round(value, 2) + 0.0:>8.2f}", "bold"), (unit, "dim"))
