"""Keeps the folder of runs in order: one table of them, rename, delete, the disk that runs take, the time that those at
work still need."""

from __future__ import annotations

import shutil
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

import numpy as np

from kit.document.blocks import Block, Cell, CellStyle, Column, Table, Text, Tone, ToneText
from kit.learning.tasks.learning_task import UnknownTask
from kit.learning.training.algorithms import UnknownAlgorithm
from kit.learning.training.events import Evaluated
from kit.learning.training.measures import VALUE_MAX, format_measure, is_value_too_large, value_warning
from kit.learning.training.run_config import RunError
from kit.learning.training.run_folders import NAME_PATTERN
from kit.learning.training.run_status import RunTracker, plan_of_run
from kit.learning.training.run_text import success_shares
from kit.learning.training.runs import TrainingRun
from kit.learning.training.training_summary import TrainingSummary
from kit.plain_text import counted, format_size, quoted
from kit.render.curve import Axes, Curve, draw_curves
from kit.render.encode import Encoder

STATE_TONES: Final[Mapping[str, Tone]] = MappingProxyType(
    {
        "running": Tone.GOOD,
        "paused": Tone.WARN,
        "finished": Tone.PLAIN,
        "stopped": Tone.WARN,
        "interrupted": Tone.WARN,
        "failed": Tone.BAD,
        "new": Tone.DIM,
    }
)


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


def runs_table(runs: Sequence[RunOverview]) -> Table:
    """A row for each run."""
    columns = (
        Column("run", CellStyle.TEXT),
        Column("state", CellStyle.TEXT),
        Column("disk", is_optional=True),
        Column("steps"),
        Column("best", decimals=3),
        Column("worst", decimals=3, is_optional=True),
        Column("value"),
        Column("time", is_optional=True),
        Column("left", CellStyle.TEXT),
        Column("reward", CellStyle.TEXT),
    )
    rows = list(map(_run_cells, runs))
    needed = [
        n
        for n, column in enumerate(columns)
        if column.title not in ("value", "left", "reward") or any(each[n] for each in rows)
    ]
    cells = tuple(tuple(each[n] for n in needed) for each in rows)
    return Table("runs", "", tuple(columns[n] for n in needed), cells, is_ruled=False)


def _run_cells(each: RunOverview) -> tuple[Cell, ...]:
    name, disk, summary = each.run.name, format_size(each.disk_bytes), each.summary
    if summary is None:
        return (name, ToneText("damaged", Tone.BAD), disk, None, None, None, None, None, "", "")
    best = worst = None
    if summary.best_evaluation is not None:
        shares = success_shares(summary.best_evaluation).values()
        best, worst = sum(shares) / len(shares), min(shares)
    left = "" if each.remaining_s is None else ToneText(format_seconds(each.remaining_s), Tone.BOLD)
    state = ToneText(summary.state, STATE_TONES[summary.state])
    time = f"{summary.seconds:.1f} s"
    return (
        name,
        state,
        disk,
        f"{summary.steps:,}",
        best,
        worst,
        _best_value_cell(summary),
        time,
        left,
        each.reward,
    )


def _best_value_cell(summary: TrainingSummary) -> Cell:
    """The largest value, marked where rewards cannot pay it."""
    if VALUE_MAX not in summary.measures:
        return None
    number = format_measure(summary.measures[VALUE_MAX])
    return ToneText(f"{number}!", Tone.BAD) if is_value_too_large(summary.measures) else number


def runs_blocks(runs: Sequence[RunOverview]) -> list[Block]:
    """The table, what is wrong with a damaged run or with the values of one, and the disk that all of them take."""
    total = sum(each.disk_bytes for each in runs)
    grown = [
        Text(f"{each.run.name}: {value_warning(each.summary.measures)}", hang=2, is_tight=True)
        for each in runs
        if each.summary is not None and is_value_too_large(each.summary.measures)
    ]
    damaged = [Text(each.problem, hang=2, is_tight=True) for each in runs if each.problem]
    return [
        runs_table(runs),
        *damaged,
        *grown,
        Text(f"{counted(len(runs), 'run')}, {format_size(total)} on disk", is_tight=True),
    ]


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
