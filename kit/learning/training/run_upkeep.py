"""Keeps the folder of runs in order: one table of them, rename, delete, the disk that runs take, the time that those at
work still need."""

from __future__ import annotations

import shutil
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from kit.learning.environment.tasks import UnknownTask
from kit.learning.training.algorithms import UnknownAlgorithm
from kit.learning.training.events import Evaluated
from kit.learning.training.run_status import RunTracker, plan_of_run
from kit.learning.training.run_text import success_shares
from kit.learning.training.runs import NAME_PATTERN, RunError, TrainingRun, TrainingSummary
from kit.plain_text import counted, format_size, quoted
from kit.render.curve import Axes, Curve, draw_curves
from kit.render.encode import Encoder


@dataclass(frozen=True, slots=True)
class RunOverview:
    """One run in a list of runs."""

    run: TrainingRun
    title: str
    """What is learned and how; empty where its configuration cannot be read."""
    reward: str
    """Name of the reward, where it is another one than the task's; else empty."""
    summary: TrainingSummary | None
    """None where the run is damaged."""
    problem: str
    """What is wrong with it, if something is."""
    disk_bytes: int
    remaining_s: float | None
    """Time to the last step, for a run that trains; None if unknown."""


def read_overviews(runs: Sequence[TrainingRun]) -> tuple[RunOverview, ...]:
    """Reads every run; what cannot be read says why."""
    return tuple(map(_read_overview, runs))


def _read_overview(run: TrainingRun) -> RunOverview:
    size = disk_bytes(run)
    try:
        config, summary = run.config(), run.summary()
        title = f"{config.choice.title}, {config.algorithm}, seed {config.seed}"
        if config.reward_name:
            title += f", reward {config.reward_name}"
    except (RunError, OSError) as error:
        return RunOverview(run, "", "", None, str(error), size, None)
    remaining = _remaining_seconds(run) if summary.state in ("running", "paused") else None
    return RunOverview(run, title, config.reward_name, summary, "", size, remaining)


def _remaining_seconds(run: TrainingRun) -> float | None:
    try:
        tracker = RunTracker(plan_of_run(run.config()))
    except (RunError, UnknownTask, UnknownAlgorithm):  # of a kit that knew others
        return None
    for event in run.events():
        tracker.add(event)
    return tracker.status(alive=True, order=run.read_command()).remaining_s


def disk_bytes(run: TrainingRun) -> int:
    """The bytes of all files of a run; one that disappears meanwhile counts as none."""
    total = 0
    for file in run.folder.rglob("*"):
        try:
            total += file.lstat().st_size if not file.is_dir() else 0
        except OSError:
            continue
    return total


def rename_run(run: TrainingRun, name: str) -> TrainingRun:
    """Gives a run another name. RunError while it is being trained, and if the name is taken or cannot be one."""
    if not NAME_PATTERN.fullmatch(name):
        raise RunError(f"{quoted(name)}: a run's name may contain letters, digits, '_', '-' and '.'.")
    renamed = run.folder.with_name(name)
    _check_idle(run, "renamed")
    if renamed.exists():
        raise RunError(f"a run {name} already exists: choose another name.")
    run.folder.rename(renamed)
    return TrainingRun(renamed)


def delete_run(run: TrainingRun) -> int:
    """Deletes a run with all its files and returns the bytes that were freed. RunError while it is being trained."""
    _check_idle(run, "deleted")
    size = disk_bytes(run)
    with run.lock():  # so that nobody begins to train it meanwhile
        shutil.rmtree(run.folder)
    return size


def _check_idle(run: TrainingRun, what: str) -> None:
    if run.is_active:
        raise RunError(
            f"{run.name} is training and cannot be {what}. `kit runs {run.name} --stop` stops it first."
        )


def format_runs(runs: Sequence[RunOverview]) -> list[str]:
    """A row for each run, and the disk that all of them take."""
    width = max([len("run"), *(len(each.run.name) for each in runs)])
    rows = [
        f"{'run':{width}}  {'state':11}  {'steps':>11}  {'time':>8}  best: mean  worst  {'disk':>10}  left, reward"
    ]
    for each in runs:
        summary = each.summary
        if summary is None:
            rows.append(f"{each.run.name:{width}}  damaged: {each.problem}")
            continue
        left = "" if each.remaining_s is None else f"  {format_seconds(each.remaining_s)}"
        reward = f"  {each.reward}" if each.reward else ""
        rows.append(
            f"{each.run.name:{width}}  {summary.state:11}  {summary.steps:>11,}  {summary.seconds:6.1f} s  "
            f"{format_best(summary)}  {format_size(each.disk_bytes):>10}{left}{reward}"
        )
    total = sum(each.disk_bytes for each in runs)
    return [*rows, f"{counted(len(runs), 'run')}, {format_size(total)} on disk"]


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
