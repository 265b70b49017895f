"""Makes, lists and finds the folders of training runs."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path

from kit.learning.training.run_config import RunConfig, RunError
from kit.learning.training.runs import TrainingRun
from kit.plain_text import quoted, suggestion
from kit.workspace import write_atomically

NAME_PATTERN = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]{0,99}")


def create_run(folder: Path, config: RunConfig, name: str | None = None) -> TrainingRun:
    """Makes a run's folder in ``folder``; by default named after what it learns. RunError if that is taken.

    The run keeps its own copies of the task's and the reward's files.
    """
    config = replace(config, choice=config.choice.frozen())
    task = config.choice.resolve()
    if config.reward_file is None and task.reward_file is not None:
        config = replace(config, reward_file=str(task.reward_file.absolute()))
    if name is not None and not NAME_PATTERN.fullmatch(name):
        raise RunError(f"{quoted(name)}: a run's name may contain letters, digits, '_', '-' and '.'.")
    made = (
        _make_folder(folder, name) if name is not None else _make_unused_folder(folder, _default_name(config))
    )
    if config.reward_file is not None:  # the run keeps its own: the student goes on writing
        write_atomically(TrainingRun(made).reward, Path(config.reward_file).read_bytes())
    for number, name in enumerate(config.imitate):
        if name.endswith(".npz"):
            write_atomically(made / f"demonstration-{number}.npz", Path(name).read_bytes())
    if config.choice.text is not None:
        write_atomically(TrainingRun(made).task, config.choice.text.encode())
    write_atomically(made / "config.json", json.dumps(config.as_dict(), indent=1).encode())
    return TrainingRun(made)


def _default_name(config: RunConfig) -> str:
    parts = [config.choice.name, *config.choice.on, config.algorithm, config.preset]
    return "-".join([*parts, str(config.seed)])[:90]


def _make_folder(folder: Path, name: str) -> Path:
    try:
        (folder / name).mkdir()
    except FileExistsError:
        raise RunError(
            f"a run {name} already exists. Choose another name with --name, or resume it: "
            f"`kit train --resume {name}`."
        ) from None
    return folder / name


def _make_unused_folder(folder: Path, name: str) -> Path:
    """The first of name, name-2, name-3, ... that is free."""
    number = 1
    while True:
        try:
            return _make_folder(folder, name if number == 1 else f"{name}-{number}")
        except RunError:
            number += 1


def list_runs(folder: Path) -> tuple[TrainingRun, ...]:
    """Every run in the folder, the one begun last first."""
    files = [(file.stat().st_mtime, file.parent) for file in folder.glob("*/config.json")]
    return tuple(TrainingRun(each) for _, each in sorted(files, reverse=True))


def find_run(folder: Path, name: str | None = None) -> TrainingRun:
    """The run of that name, or, without one, the one begun last. RunError if there is none."""
    runs = {run.name: run for run in list_runs(folder)}
    if name is None:
        if not runs:
            raise RunError("There are no runs yet. `kit train turn` starts one.")
        return next(iter(runs.values()))
    if name in runs:
        return runs[name]
    if not runs:
        raise RunError(f"There is no run {quoted(name)}, nor any other. `kit train turn` starts one.")
    raise RunError(f"There is no run {quoted(name)}: {suggestion(name, runs)}")
