"""A training that runs as rows of text: its figures, curves, cases and keys."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from types import MappingProxyType
from typing import TYPE_CHECKING, Final

import numpy as np

from kit.arrays import FloatArray
from kit.dialogue.actions import ScreenActions
from kit.document.rows import Row, at_both_edges, row
from kit.learning.training.measures import (
    MEASURES,
    VALUE_MAX,
    VALUE_PAYABLE,
    format_measure,
    is_value_too_large,
)
from kit.render.curve import Axes, Curve
from kit.render.roles import Role
from kit.render.stacked_chart import ChartPart, StackedCounts
from kit.tui.rows.agent_rows import agent_panel
from kit.tui.rows.key_rows import footer

if TYPE_CHECKING:
    from kit.learning.training.demonstration import DemonstrationView
    from kit.learning.training.run_status import CaseStatus, RunStatus


OUTCOMES: Final = (
    ChartPart("reached", Role.TARGET, "█"),
    ChartPart("collided", Role.CONTACT, "▒"),
    ChartPart("timed out", Role.HIT, "░"),
)
"""In the order of ``kit.learning.environment.episode_stats.EpisodeOutcome``, and called as there."""
ASCII_OUTCOMES: Final = tuple(
    ChartPart(part.name, part.role, glyph) for part, glyph in zip(OUTCOMES, "#x.", strict=True)
)
OUTCOME_STYLES: Final = ("good", "bad", "warn")

MARGIN: Final = 5
"""Columns for the scales of the curve and of the outcomes."""
RECENTLY: Final = "last 10 batches"
"""Over which the present figures are means; see ``kit.learning.training.run_status.RECENT_REPORTS``."""
THREE_CURVES_FROM: Final = 49
"""Columns from which on the names of three curves fit."""
NAME: Final = 15
"""Columns for the name of a case where several stand in a row."""

_STATES: Final[Mapping[str, tuple[str, str]]] = MappingProxyType(
    {
        "new": ("starting", "dim"),
        "running": ("training", "good"),
        "paused": ("paused", "warn"),
        "finished": ("finished", "good"),
        "stopped": ("stopped", "warn"),
        "interrupted": ("interrupted", "warn"),
        "failed": ("failed", "bad"),
    }
)


def heading(name: str, status: RunStatus, width: int) -> Row:
    """Returns the heading: on the left the task, on the right the state of the training and its duration."""
    left = row((name, "title"), "  ", (status.plan.title, "dim"))
    right = row(_STATES[status.summary.state], "  ", (clock(status.summary.seconds), "bold"))
    return at_both_edges(left, right, width)


def clock(seconds: float) -> str:
    """``0:42``, ``12:05``, ``3:00:10``."""
    minutes, rest = divmod(int(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02}:{rest:02}" if hours else f"{minutes}:{rest:02}"


def figures(status: RunStatus, width: int) -> Row:
    """Steps, speed, time left, and as much more as there is room for."""
    summary = status.summary
    parts = [row((f"{summary.steps:,}", "bold"), (f" of {status.plan.steps:,} steps", "dim"))]
    if VALUE_MAX in status.measures:
        parts.append(_largest_value(status.measures))
    if summary.state == "running" and status.rate:
        parts.append(row((f"{status.rate:,.0f}", "bold"), (" steps/s", "dim")))
    if status.remaining_s is not None:
        parts.append(row(("at most ", "dim"), (clock(status.remaining_s), "bold"), (" left", "dim")))
    if status.adjacency:
        parts.append(row(("side by side ", "dim"), (f"{status.adjacency:.0%}", "bold")))
    if status.reward is not None:
        parts.append(row(("reward ", "dim"), (f"{status.reward:.2f}", "bold"), (f" {RECENTLY}", "dim")))
    shown: Row = parts[0]
    for part in parts[1:]:
        longer = (*shown, *row("   "), *part)
        if sum(len(text) for text, _ in longer) <= width:
            shown = longer
    return shown


def _largest_value(measures: Mapping[str, float]) -> Row:
    """The largest value, and whether rewards can pay it."""
    told, number = MEASURES[VALUE_MAX].title, format_measure(measures[VALUE_MAX])
    if not is_value_too_large(measures):
        return row((f"{told} ", "dim"), (number, "bold"))
    most = format_measure(measures[VALUE_PAYABLE])
    return row((f"{told} {number}, rewards pay {most}", "bad"))


def note(name: str, status: RunStatus, width: int) -> Row:
    """Says what happened last, and what can be done where nothing is being trained."""
    state = status.summary.state
    if state == "interrupted":
        return row((f"{name} was interrupted. p continues from its last checkpoint."[:width], "warn"))
    style = "bad" if state == "failed" else ""
    hint = "  p continues" if state == "stopped" else ""
    return row((f"{_whole_parts(status.note, width - len(hint))}{hint}", style))


def _whole_parts(text: str, width: int) -> str:
    """As many parts of a sentence, between commas or semicolons, as fit; at least a piece of the first."""
    while len(text) > width and (end := max(text.rfind(", "), text.rfind("; "))) > 0:
        text = text[:end]
    return text[:width]


def caption(moment: DemonstrationView, width: int) -> Row:
    """Names the case, the policy that drives, and how the episode ended."""
    policy = f"{'best, of' if moment.kept else 'after'} {_short_count(moment.trained)}"
    # "case": the row stands beside the names of curves.
    left = row(("case ", "dim"), (moment.case, "bold"), (f"  {policy}", "dim"))
    if moment.outcome is None:
        return at_both_edges(left, (), width)
    names = [part.name for part in OUTCOMES]
    style = OUTCOME_STYLES[names.index(moment.outcome.value)]
    return at_both_edges(left, row((moment.outcome.value, style)), width)


def agent(name: str, moment: DemonstrationView, width: int, height: int) -> tuple[Row, ...]:
    """The policy, its environment and return so far, what it perceives and how it rates its actions."""
    about = (
        ("agent", f"{name}, {'best' if moment.kept else 'newest'} of {_short_count(moment.trained)}"),
        ("environment", f"{moment.environment}, {moment.case}"),
        ("step", f"{moment.step}"),
        *((("return so far", f"{moment.total_reward:.3f}"),) if moment.total_reward is not None else ()),
    )
    return agent_panel(moment.agent, about, width, height)


def _short_count(steps: int) -> str:
    """Formats steps in few characters: 850, 49k, 1.25M."""
    if steps < 1000:
        return str(steps)
    return f"{steps / 1000:.0f}k" if steps < 999_500 else f"{steps / 1e6:.2f}M"


# What the curve and the outcomes are drawn from


def axes(status: RunStatus, kind: str) -> Axes:
    """Returns the axes of a curve: ``success``, ``reward`` or a metric."""
    if kind != "success":
        return Axes("steps", margin=MARGIN)
    return Axes("steps", low=0.0, high=1.0, goal=status.plan.goal, margin=MARGIN)


def curve_kinds(status: RunStatus) -> tuple[str, ...]:
    """The quantities that there are curves of."""
    return "success", "reward", *status.batches.metrics


def curves(status: RunStatus, kind: str, columns: int) -> tuple[Curve, ...]:
    """A quantity of each batch, or success: in training, and in tests on average and in the worst case, if there is
    room for both."""
    batches, evaluations = status.batches, status.evaluations
    if kind == "reward":
        return (Curve("reward in training, by batch", batches.steps, batches.reward),)
    if kind != "success":
        values = batches.metrics.get(kind, np.full(len(batches.steps), np.nan))
        return (Curve(f"{kind}, by batch", batches.steps, values),)
    share = batches.outcomes[:, 0] / batches.outcomes.sum(axis=1) if len(batches.steps) else np.empty(0)
    trained = Curve("training", batches.steps, _two_decimals(share))
    worst = Curve("worst", evaluations.steps, _two_decimals(evaluations.worst))
    if columns < THREE_CURVES_FROM:
        return trained, Curve("worst test", worst.x, worst.y)
    return trained, Curve("test", evaluations.steps, _two_decimals(evaluations.mean)), worst


def _two_decimals(values: FloatArray) -> FloatArray:
    """Rounds to two decimals: the newest value stands beside its curve's name."""
    return np.round(values, 2)


def shares(status: RunStatus) -> StackedCounts:
    """How the episodes ended, batch by batch."""
    return StackedCounts(status.batches.steps, status.batches.outcomes)


# What stands in the panel


def pages(status: RunStatus, width: int, height: int) -> tuple[tuple[Row, ...], ...]:
    """Cases, terms of the reward, and what the learner measures, on as few pages as they fit on; at least one."""
    width = max(width, NAME + 4)
    blocks = [_case_rows(status, width, height), _term_rows(status, width)]
    if status.measures:
        blocks.append(_measure_rows(status, width))
    made: list[tuple[Row, ...]] = []
    for title, rows in blocks:
        for start in range(0, len(rows), max(1, height - 1)):
            block = (title, *rows[start : start + max(1, height - 1)])
            if made and len(made[-1]) + len(block) <= height:
                made[-1] = (*made[-1], *block)
            else:
                made.append(block)
    return tuple(made) or ((),)


def _case_rows(status: RunStatus, width: int, height: int) -> tuple[Row, list[Row]]:
    """Every case: how its episodes ended in training and how many reached the target in the last test; where they
    are too many, only the latter, several in a row."""
    names = short_names([case.name for case in status.cases])
    cases = list(zip(names, status.cases, strict=True))
    if len(cases) < height:
        wide = max(len("case"), *map(len, names))
        bar = max(0, width - wide - 13)
        title = row((f"{'case':{wide}} {'recent':{bar}} train  test"[:width], "title"))
        return title, [_case_row(name.ljust(wide), case, bar) for name, case in cases]
    per_row = max(1, (width + 1) // (NAME + 5))
    tested = any(sum(case.last_evaluation) for case in status.cases)
    title = row((f"% reached, {'last test' if tested else 'in training'}"[:width], "title"))
    cells = [
        _cell(name, case.last_evaluation if tested else case.trained, status.plan.goal)
        for name, case in cases
    ]
    down = -(-len(cells) // per_row)
    return title, [tuple(part for cell in cells[line::down] for part in cell) for line in range(down)]


def _case_row(name: str, case: CaseStatus, bar: int) -> Row:
    trained, tested = _percent_text(case.trained), _percent_text(case.last_evaluation)
    return row(f"{name} ", *_outcome_bar(case.trained, bar), f"{trained:>6}", (f"{tested:>5} ", "bold"))


def _outcome_bar(counts: Sequence[int], width: int) -> tuple[tuple[str, str], ...]:
    total = sum(counts)
    if not total:
        return ((" " * width, ""),)
    ends = [0, *(round(sum(counts[: place + 1]) / total * width) for place in range(len(counts)))]
    lengths = [stop - start for start, stop in pairwise(ends)]
    parts = zip(OUTCOMES, OUTCOME_STYLES, lengths, strict=True)
    return tuple((part.glyph * length, style) for part, style, length in parts if length)


def _cell(name: str, counts: Sequence[int], goal: float | None) -> Row:
    enough = sum(counts) and goal is not None and counts[0] / sum(counts) >= goal
    return row(f"{name:{NAME}.{NAME}}", (f"{_percent_text(counts):>4}", "good" if enough else "bold"), " ")


def _percent_text(counts: Sequence[int]) -> str:
    """Rounded down: 100 means all."""
    return f"{100 * counts[0] // sum(counts)}" if sum(counts) else "-"


def short_names(names: Sequence[str]) -> list[str]:
    """Removes the first words that all names have in common."""
    words = [name.split("_") for name in names]
    while len(words) > 1 and len({each[0] for each in words}) == 1 and all(each[1:] for each in words):
        words = [each[1:] for each in words]
    return ["_".join(each) for each in words]


def _term_rows(status: RunStatus, width: int) -> tuple[Row, list[Row]]:
    """The reward per episode by named term."""
    total = "" if status.reward is None else f" {status.reward:.2f}"
    told = f"reward per episode{total}, {RECENTLY}"
    title = row((told if len(told) <= width else f"reward{total}, {RECENTLY}"[:width], "title"))
    per_row = max(1, width // 28)
    cell = width // per_row
    cells = [
        row(f"{name:{cell - 10}.{cell - 10}}", (f"{value:>9.2f} ", "bold"))
        for name, value in status.terms.items()
    ]
    down = -(-len(cells) // per_row)
    return title, [tuple(part for each in cells[line::down] for part in each) for line in range(down)]


def _measure_rows(status: RunStatus, width: int) -> tuple[Row, list[Row]]:
    """What the learner last measured of its own learning."""
    rows = [
        row(f"{MEASURES[name].title:{width - 14}.{width - 14}}", (f"{format_measure(number):>13} ", "bold"))
        for name, number in status.measures.items()
        if name in MEASURES
    ]
    return row(("the learner, by its last batch"[:width], "title")), rows


# The line of keys, and the last words


def keys(actions: ScreenActions, state: str, width: int) -> Row:
    """The line at the bottom, for a training in this state."""
    is_idle = state in ("paused", "stopped", "interrupted")
    can = {"pause": state == "running" or is_idle, "stop": state in ("running", "paused")}
    labels = {"choose_map": "case"}
    if is_idle:
        labels["pause"] = "continue"
    elif state == "running":
        labels["back"] = "back, it continues"
    return footer(
        actions, width, without=[each for each, possible in can.items() if not possible], labels=labels
    )


_FAREWELLS: Final[Mapping[str, str]] = MappingProxyType(
    {
        "running": "{0} continues training. `kit watch {0}` shows it again, `kit runs {0} --stop` stops it.",
        "new": "{0} continues training. `kit watch {0}` shows it again, `kit runs {0} --stop` stops it.",
        "paused": "{0} stays paused. `kit watch {0}` shows it again, `kit runs {0} --go` continues it.",
        "stopped": "{0} is stopped. `kit train --resume {0}` continues it.",
        "interrupted": "{0} was interrupted. `kit train --resume {0}` continues from its last checkpoint.",
        "finished": "{0} has finished. `kit evaluate {0}` tests the best policy.",
        "failed": "{0} has failed. `kit runs {0}` says why.",
    }
)


def farewell(name: str, state: str) -> str:
    """How the run stands, and how to come back."""
    return _FAREWELLS[state].format(name)
