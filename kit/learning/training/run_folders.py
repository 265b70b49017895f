"""Makes, lists and finds the folders of training runs."""

from __future__ import annotations

import errno
import json
import re
from collections.abc import Iterable, Iterator
from dataclasses import replace
from itertools import count
from pathlib import Path

from kit.learning.training.run_config import RunConfig, RunError
from kit.learning.training.runs import TrainingRun
from kit.plain_files import foreign_part
from kit.plain_text import quoted, unknown_name
from kit.workspace import draft_folder, write_atomically

NAME_PATTERN = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]{0,99}")


class RunExists(RunError):
    """The name of a new run is taken."""


def create_run(folder: Path, config: RunConfig, name: str | None = None) -> TrainingRun:
    """Makes a run's folder in ``folder``; by default named after what it learns. RunExists if the name is taken,
    RunError, and OSError.

    The run keeps its own copies of the task's and the reward's files.
    """
    config = replace(config, choice=config.choice.frozen())
    task = config.choice.resolve()
    if config.reward_file is None and task.reward_file is not None:
        config = replace(config, reward_file=str(task.reward_file.absolute()))
    if name is not None and not NAME_PATTERN.fullmatch(name):
        raise RunError(f"{quoted(name)}: a run's name may contain letters, digits, '_', '-' and '.'.")
    with draft_folder(folder) as draft:
        _fill(TrainingRun(draft), config)
        return TrainingRun(
            _rename_to_first_free(draft, [name] if name is not None else _default_names(config))
        )


def _fill(run: TrainingRun, config: RunConfig) -> None:
    """Writes the run's configuration, and its own copies of the files that it needs."""
    if config.reward_file is not None:  # the student goes on writing in theirs
        write_atomically(run.reward, Path(config.reward_file).read_bytes())
    for number, name in enumerate(config.imitate):
        if name.endswith(".npz"):
            write_atomically(run.folder / f"demonstration-{number}.npz", Path(name).read_bytes())
    if config.choice.text is not None:
        write_atomically(run.task, config.choice.text.encode())
    write_atomically(run.folder / "config.json", json.dumps(config.as_dict(), indent=1).encode())


def _default_names(config: RunConfig) -> Iterator[str]:
    """What it learns, then the same with -2, -3 and so on."""
    parts = [config.choice.name, *config.choice.on, config.algorithm, config.preset]
    name = "-".join([*parts, str(config.seed)])[:90]
    yield name
    yield from (f"{name}-{number}" for number in count(2))


def _rename_to_first_free(draft: Path, names: Iterable[str]) -> Path:
    """Gives a run its name, whole, so that no other process finds a part of it. Raises RunExists if all are taken."""
    for name in names:
        try:
            return draft.rename(draft.with_name(name))
        except OSError as error:
            if error.errno not in (errno.EEXIST, errno.ENOTEMPTY, errno.ENOTDIR):
                raise
    raise RunExists(
        f"a run {name} already exists. Choose another name with --name, or resume it: `kit train --resume {name}`."
    )


def list_runs(folder: Path) -> tuple[TrainingRun, ...]:
    """Every run in the folder, the one begun last first; without those that ``left_out`` tells of."""
    return tuple(run for run in _all_runs(folder) if not foreign_part(run.folder))


def left_out(folder: Path) -> tuple[str, ...]:
    """A sentence for each run in the folder that is neither read nor written, with the reason."""
    return tuple(problem for run in _all_runs(folder) if (problem := _problem_of(run)))


def _all_runs(folder: Path) -> list[TrainingRun]:
    files = [(file.stat().st_mtime, file.parent) for file in folder.glob("[!.]*/config.json")]
    return [TrainingRun(each) for _, each in sorted(files, reverse=True)]


def _problem_of(run: TrainingRun) -> str:
    part = foreign_part(run.folder)
    return (
        f"{run.folder}: {part}. A run has plain files alone, because the kit writes to them: replace or delete it."
        if part
        else ""
    )


def find_run(folder: Path, name: str | None = None) -> TrainingRun:
    """The run of that name, or, without one, the one begun last. RunError if there is none, or if it is left out."""
    runs = {run.name: run for run in _all_runs(folder)}
    if name is None:
        if not runs:
            raise RunError("There are no runs yet. `kit train turn` starts one.")
        name = next(iter(runs))
    if name in runs:
        if problem := _problem_of(runs[name]):
            raise RunError(problem)
        return runs[name]
    if not runs:
        raise RunError(f"There is no run {quoted(name)}, nor any other. `kit train turn` starts one.")
    raise RunError(unknown_name("run", name, runs, "kit runs"))
