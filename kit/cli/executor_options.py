"""The options that say how many jobs run side by side and where: here, by SLURM, by Dask."""

from __future__ import annotations

import os
from collections.abc import Callable
from functools import reduce, wraps
from typing import TYPE_CHECKING, Any

import click

from kit.cli.options import Decorator

if TYPE_CHECKING:
    from kit.host.job_executors import SlurmResources
    from kit.host.job_folder import ExecutorName


def _read_slurm_resources(
    context: click.Context, parameter: click.Parameter, given: tuple[str, ...]
) -> SlurmResources:
    from kit.host.job_executors import SlurmResources  # what few verbs need

    try:
        return SlurmResources.read(given)
    except ValueError as error:
        raise click.BadParameter(str(error)) from None


def executor_options(jobs: str, executor: str, *, may_have_none: bool = True) -> Decorator:
    """The options ``--jobs``, ``--executor``, ``--cluster`` and ``--slurm``: how many side by side, and where; the verb gets all
    of it as ``executor``. Both texts are helps."""
    names = ("local", "slurm", "dask", *(("none",) if may_have_none else ()))
    options = (
        click.option(
            "--jobs",
            type=click.IntRange(1),
            default=os.cpu_count() or 1,
            show_default=True,
            help=f"{jobs}, or tasks in an array job.",
        ),
        click.option(
            "--executor", type=click.Choice(names), default="local", show_default=True, help=executor
        ),
        click.option("--cluster", default="", metavar="ADDRESS", help="Address of the Dask scheduler."),
        click.option(
            "--slurm",
            multiple=True,
            metavar="NAME=VALUE",
            callback=_read_slurm_resources,
            help="What a task asks SLURM for: account, partition, qos, time (04:00:00) or memory (4G); repeat for more.",
        ),
    )

    def decorate(function: Callable[..., Any]) -> Callable[..., Any]:
        @wraps(function)
        def verb(
            *args: Any, executor: ExecutorName, jobs: int, cluster: str, slurm: SlurmResources, **given: Any
        ) -> Any:
            from kit.host.job_folder import JobExecutor  # what few verbs need

            return function(*args, executor=JobExecutor(executor, jobs, cluster, slurm), **given)

        return reduce(lambda made, option: option(made), reversed(options), verb)

    return decorate
