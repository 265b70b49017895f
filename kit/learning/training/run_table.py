"""Formats lists of runs as text: a row for each, and the curves of their tests in one picture."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from kit.learning.training.events import Evaluated
from kit.learning.training.run_text import success_shares
from kit.learning.training.run_upkeep import RunOverview, size_text
from kit.learning.training.runs import TrainingRun, TrainingSummary
from kit.render.curve import Axes, Curve, draw_curves
from kit.render.encode import Encoder


def format_runs(runs: Sequence[RunOverview]) -> list[str]:
    """A row for each run, and the disk that all of them take."""
    width = max([len("run"), *(len(each.run.name) for each in runs)])
    rows = [
        f"{'run':{width}}  {'state':11}  {'steps':>11}  {'time':>8}  best: mean  worst  {'disk':>8}  left"
    ]
    for each in runs:
        summary = each.summary
        if summary is None:
            rows.append(f"{each.run.name:{width}}  damaged: {each.problem}")
            continue
        left = "" if each.remaining_s is None else f"  {format_seconds(each.remaining_s)}"
        rows.append(
            f"{each.run.name:{width}}  {summary.state:11}  {summary.steps:>11,}  {summary.seconds:6.1f} s  "
            f"{format_best(summary)}  {size_text(each.disk_bytes):>8}{left}"
        )
    total = sum(each.disk_bytes for each in runs)
    return [*rows, f"{len(runs)} run{'s' if len(runs) != 1 else ''}, {size_text(total)} on disk"]


def format_seconds(seconds: float) -> str:
    """``40 s``, ``12 min``, ``3 h 05 min``."""
    if seconds < 90:
        return f"{seconds:.0f} s"
    minutes = round(seconds / 60)
    return f"{minutes} min" if minutes < 60 else f"{minutes // 60} h {minutes % 60:02} min"


def draw_test_curves(runs: Sequence[TrainingRun], columns: int, rows: int, encoder: Encoder) -> list[str]:
    """The mean success of all tests of each run over its steps."""
    drawn = []
    for run in runs:
        tests = [event for event in run.events() if isinstance(event, Evaluated)]
        means = [float(np.mean([*success_shares(test).values()])) for test in tests]
        drawn.append(Curve(run.name, np.array([float(test.steps) for test in tests]), np.array(means)))
    return draw_curves(drawn, Axes("steps", 0.0, 1.0), columns, rows, encoder).rows()


def format_best(summary: TrainingSummary) -> str:
    """Mean and worst success of the best test, in 16 columns."""
    if summary.best_evaluation is None:
        return "         -      -"
    shares = success_shares(summary.best_evaluation).values()
    return f"     {sum(shares) / len(shares):5.3f}  {min(shares):5.3f}"
