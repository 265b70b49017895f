"""``kit warm``: compiles the kernels before anybody waits for them, for this account or for all of a machine."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterator
from functools import partial
from typing import TYPE_CHECKING, Final

import click
import numpy as np

from kit.cli import messages
from kit.controllers import find_controller
from kit.kernels.compilation_progress import PROGRESS
from kit.kernels.shared_cache import let_all_read, make_ready, shared_folders, unshared_reason
from kit.plain_text import counted
from kit.run.headless import run_headless
from kit.run.scenario import find_scenario

if TYPE_CHECKING:
    from kit.learning.tasks.learning_task import LearningTask

DRIVES: Final = (("maze", "random_walk"), ("pair_turn_180", "fields"))
"""A place with lasers, whose walls are looked at by a controller, and one whose controller follows a potential field."""
TICKS: Final = 60
"""Of each drive: every sensor has measured by then."""
WORLDS: Final = 2
"""Of each task, side by side."""
MIB: Final = 1 << 20


@click.command()
@click.option(
    "--shared",
    is_flag=True,
    help="For all accounts of this machine, read-only, within the installation; as root.",
)
def command(shared: bool) -> None:
    """Compile all that worlds and training compute with, so that no first start waits for it.

    On a machine with many accounts, after each installation:

    \b
    sudo kit warm --shared

    Every account then finds these kernels by itself, and so does the grader. They are not used where others than their owner
    may write them; `kit doctor` says so. What an account compiles besides stays its own.

    Exit code: 0 all is compiled; 2 it cannot be kept for all accounts, and why.
    """
    if shared:
        _open_installation()
    began = time.perf_counter()
    for title, use in uses_of_kernels():
        with PROGRESS.told_by(lambda text: click.echo(text, err=True)):
            click.echo(title, err=True)
            use()
    took = time.perf_counter() - began
    messages.say(f"{counted(PROGRESS.count, 'function')} compiled, all others read, in {took:.0f} s.")
    if shared:
        _close_installation()


def uses_of_kernels() -> Iterator[tuple[str, Callable[[], object]]]:
    """Yields each step's description and function; after all of them every kernel has been compiled for all its uses."""
    for place, controller in DRIVES:
        yield f"a drive of {controller} in {place}", partial(_drive, place, controller)
    # Only here: tasks import Gymnasium, which takes longer than a light verb may.
    from kit.learning.tasks.catalogue import all_tasks

    for task in all_tasks():
        yield f"the task {task.name}", partial(_step, task)


def _drive(place: str, controller: str) -> None:
    run_headless(find_scenario(place), find_controller(controller), steps=TICKS)


def _step(task: LearningTask) -> None:
    from kit.learning.environment.batch import BatchEnv

    batch = BatchEnv(task, WORLDS)
    batch.action_space.seed(0)
    batch.reset(0)
    for _ in range(2):
        batch.step(np.stack([batch.action_space.sample() for _ in range(WORLDS)]))


def _open_installation() -> None:
    """Prepares the folders for all accounts, before anything is read from them."""
    if os.geteuid() != 0:
        messages.fail("--shared: only root makes what all accounts run: sudo kit warm --shared")
    os.environ.pop("NUMBA_CACHE_DIR", None)  # it would keep them elsewhere
    os.umask(0o022)
    try:
        for folder in shared_folders():
            make_ready(folder)
    except OSError as error:
        messages.fail(f"--shared: {error.filename}: {error.strerror}")


def _close_installation() -> None:
    try:
        size = sum(let_all_read(folder) for folder in shared_folders())
    except OSError as error:
        messages.fail(f"--shared: {error.filename}: {error.strerror}")
    for folder in shared_folders():
        if problem := unshared_reason(folder):
            messages.fail(f"--shared: {problem}.")
    messages.say(
        f"{size / MIB:.1f} MB for all accounts in {shared_folders()[0]}, which only their owner may write."
    )
