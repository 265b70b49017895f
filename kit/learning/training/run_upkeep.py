"""Keeps the folder of runs in order: rename, delete, the disk that runs take, the time that those at work still need."""

from __future__ import annotations

import shutil
from collections.abc import Sequence
from dataclasses import dataclass

from kit.learning.environment.tasks import UnknownTask
from kit.learning.training.algorithms import UnknownAlgorithm
from kit.learning.training.run_status import RunTracker, plan_of_run
from kit.learning.training.runs import NAME_PATTERN, RunError, TrainingRun, TrainingSummary
from kit.plain_text import quoted


@dataclass(frozen=True, slots=True)
class RunOverview:
    """One run in a list of runs."""

    run: TrainingRun
    title: str
    """What is learned and how; empty where its configuration cannot be read."""
    summary: TrainingSummary | None
    """None where the run is damaged."""
    problem: str
    """What is wrong with it, if something is."""
    disk_bytes: int
    remaining_s: float | None
    """To the last step, for a run at work; None where nothing is known."""


def read_overviews(runs: Sequence[TrainingRun]) -> tuple[RunOverview, ...]:
    """Reads every run; what cannot be read says why."""
    return tuple(map(_read_overview, runs))


def _read_overview(run: TrainingRun) -> RunOverview:
    size = disk_bytes(run)
    try:
        config, summary = run.config(), run.summary()
        title = f"{config.choice.title}, {config.algorithm}, seed {config.seed}"
    except (RunError, OSError) as error:
        return RunOverview(run, "", None, str(error), size, None)
    remaining = _remaining_seconds(run) if summary.state in ("running", "paused") else None
    return RunOverview(run, title, summary, "", size, remaining)


def _remaining_seconds(run: TrainingRun) -> float | None:
    try:
        tracker = RunTracker(plan_of_run(run.config()))
    except (UnknownTask, UnknownAlgorithm):  # of a kit that knew others
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
        raise RunError(f"{quoted(name)}: a run's name is made of letters, digits, '_', '-' and '.'.")
    renamed = run.folder.with_name(name)
    _check_idle(run, "renamed")
    if renamed.exists():
        raise RunError(f"there is a run {name} already: choose another name.")
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
            f"{run.name} is being trained and cannot be {what}. `kit runs {run.name} --stop` stops it first."
        )


def size_text(size: int) -> str:
    """``850 kB``, ``12.3 MB``."""
    return f"{size / 1e3:.0f} kB" if size < 1e6 else f"{size / 1e6:.1f} MB"
