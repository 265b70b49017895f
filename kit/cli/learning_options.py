"""Options of the learning verbs: finds runs and policies, and explains errors."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from functools import wraps
from pathlib import Path
from typing import Any

import click

from kit.cli import messages
from kit.controllers import find_controller
from kit.host.failure import StudentCodeError
from kit.learning.maps.batch_map import UnsupportedWorld
from kit.learning.policies.policy import Policy, PolicyError
from kit.learning.policies.policy_file import TORCH_SUFFIXES, load_policy
from kit.learning.tasks.disturbances import DISTURBANCE_KINDS, DisturbanceError, DisturbanceKind, UniformRange
from kit.learning.tasks.learning_task import LearningTask, UnknownTask
from kit.learning.tasks.student_reward import RewardFileError
from kit.learning.training.algorithms import UnknownAlgorithm, UnsuitableAlgorithm
from kit.learning.training.demonstrations import DemonstrationError
from kit.learning.training.learn_extra import LearnExtraMissing
from kit.learning.training.run_config import NO_LIMIT, RunError
from kit.learning.training.run_folders import find_run
from kit.plain_files import near_file
from kit.run.recording import RecordingError
from kit.workspace import WorkspaceError, open_workspace
from kit.world.problems import WorldError

on = click.option(
    "--on",
    metavar="CASES",
    help="Only these cases or groups of the task, separated by commas: doors,straight.",
)
plain = click.option(
    "--plain",
    is_flag=True,
    help="Print lines of text instead of a full screen: for screen readers and pipes.",
)
episodes = click.option(
    "--episodes",
    type=click.IntRange(1, 1_000_000),
    default=500,
    show_default=True,
    help="Episodes per case.",
)
sampled = click.option(
    "--sampled", is_flag=True, help="Sample actions, as in training, instead of taking the best ones."
)
test_seed = click.option(
    "--seed",
    type=click.IntRange(0, 2**31 - 1),
    default=1,
    show_default=True,
    help="Random seed of the test episodes; training never uses the same ones.",
)


def _read_range(kind: DisturbanceKind, text: str | None) -> UniformRange | None:
    """Reads an option's number or range. Raises BadParameter for one that is impossible."""
    if text is None:
        return None
    try:
        found = UniformRange.parse(text)
        kind.check(found)
    except DisturbanceError as error:
        raise click.BadParameter(str(error)) from None
    return found


def disturbances(function: Callable[..., Any]) -> Callable[..., Any]:
    """Decorator: adds an option for each kind of disturbance, and passes those that are given as ``disturbed``, by name."""

    @wraps(function)
    def verb(*arguments: Any, **values: Any) -> Any:
        given = {kind.name: values.pop(kind.name) for kind in DISTURBANCE_KINDS}
        disturbed = {name: found for name, found in given.items() if found is not None}
        return function(*arguments, disturbed=disturbed, **values)

    for kind in reversed(DISTURBANCE_KINDS):
        unit = f" [{kind.unit}]" if kind.unit else ""
        verb = click.option(
            f"--{kind.option}",
            kind.name,
            callback=lambda ctx, param, text, kind=kind: _read_range(kind, text),
            metavar="X|LOW:HIGH",
            help=kind.summary.removesuffix(".") + unit + ".",
        )(verb)
    return verb


def split_names(text: str | None) -> tuple[str, ...]:
    """Splits a comma-separated list."""
    return tuple(part.strip() for part in (text or "").split(",") if part.strip())


def _read_settings(
    context: click.Context, parameter: click.Parameter, texts: tuple[str, ...]
) -> dict[str, tuple[float, ...]]:
    """``gamma=0.95,0.99``: a name, and the numbers to train with, each once."""
    found: dict[str, tuple[float, ...]] = {}
    for text in texts:
        name, _, numbers = text.partition("=")
        name = name.strip()
        if name in found:
            raise click.BadParameter(f"{name} is given more than once.")
        try:
            found[name] = tuple(dict.fromkeys(map(_read_setting, numbers.split(","))))
        except ValueError:
            raise click.BadParameter(f"{text}: give NAME=NUMBER, such as gamma=0.98.") from None
        if any(map(math.isnan, found[name])):
            raise click.BadParameter(f"{text}: the number must be finite, or `none` for no limit.")
    return found


def _read_setting(text: str) -> float:
    """ValueError for anything but a number, or ``none`` for a limit that there is not."""
    return math.inf if text.strip() == NO_LIMIT else float(text)


def settings_option(metavar: str, more: str) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """The option ``--set``; ``more``: the end of its help."""
    return click.option(
        "--set",
        "settings",
        metavar=metavar,
        multiple=True,
        callback=_read_settings,
        help=f"Change a setting of the algorithm; {more}; `kit train TASK --list` names them; repeat for more.",
    )


@contextmanager
def explained_errors() -> Iterator[None]:
    """Ends the verb with one clear line for every error that a user can cause."""
    try:
        yield
    except UnknownAlgorithm as error:
        messages.fail(str(error))
    except (
        StudentCodeError,
        LearnExtraMissing,
        PolicyError,
        RewardFileError,
        RunError,
        DemonstrationError,
        RecordingError,
        DisturbanceError,
        UnsuitableAlgorithm,
        UnsupportedWorld,
    ) as error:
        messages.fail(str(error))
    except WorldError as error:
        count = len(error.problems)
        messages.fail(str(error) if count == 1 else f"{error}\n\n{count} problems")
    except (UnknownTask, WorkspaceError) as error:
        messages.fail(str(error))
    except OSError as error:
        messages.fail(messages.describe_os_error(error))


def runs_folder(workspace: Path | None) -> Path:
    """The folder of the training runs. Raises WorkspaceError."""
    return open_workspace(workspace).runs


def find_demonstrations(names: tuple[str, ...], workspace: Path | None) -> tuple[Path, ...]:
    """The files of those who are imitated: a recording or a policy by its file, a run's best policy by the run's name, a
    controller by name or file. DemonstrationError if something is none of these."""
    if not names:
        return ()
    opened, found = open_workspace(workspace), []
    for name in names:
        if name.endswith(".npz"):
            if not Path(name).is_file():
                near = near_file(name)
                hint = f" Did you mean {near}?" if near else ""
                raise DemonstrationError(f"{name}: there is no such file.{hint}")
            found.append(Path(name).absolute())
        elif (opened.runs / name / "best.npz").is_file():
            found.append(opened.runs / name / "best.npz")
        else:
            try:
                found.append(find_controller(name, opened.controllers).file)
            except LookupError as error:
                raise DemonstrationError(
                    f"{error} It is not a training run with a policy or a policy file either."
                ) from None
    return tuple(found)


def _is_file(name: str) -> bool:
    """Whether a policy's name is that of a file, and not of a run."""
    return name.endswith((".npz", ".zip", *TORCH_SUFFIXES)) or "/" in name


def find_policy(name: str | None, workspace: Path | None, *, newest: bool = False) -> tuple[str, Policy]:
    """Finds a policy by the name of its run, or by its file; without a name that of the last run. Returns its title too."""
    if name is not None and _is_file(name):
        return Path(name).stem, load_policy(Path(name))
    run = find_run(runs_folder(workspace), name)
    return run.name, run.policy(newest=newest)


def sweep_journal(name: str | None, workspace: Path | None) -> Path:
    """The file that keeps the sweep of a policy, which is named as in ``find_policy``: beside it, or in its run."""
    if name is not None and _is_file(name):
        return Path(name).with_suffix(".sweep.jsonl")
    return find_run(runs_folder(workspace), name).folder / "sweep.jsonl"


def resolve_test_task(
    policy: Policy, task: str | None, on: str | None, disturbed: Mapping[str, UniformRange] | None = None
) -> LearningTask:
    """Finds the task to test a policy on: the one it was trained on, or another with the same inputs and actions; with
    other disturbances than its own, by kind."""
    choice = policy.trained_on
    if task is not None:
        choice = replace(choice, task=task, text=None, on=())
    if on is not None:
        choice = replace(choice, on=() if on == "all" else split_names(on))
    found = choice.resolve()
    return replace(found, disturbances=found.disturbances.changed(disturbed or {}))
