"""A folder of jobs that are known by their keys, and where they are run.

What a job is, and what is kept of it, each kind of folder says: a class of submissions is graded so, and a sweep of trainings,
the study's too, is run so. Any number of processes and machines share the work, and what was interrupted goes on where it was.
"""

from __future__ import annotations

import os
import sys
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import ClassVar, Final, Literal

from kit.host.job_executors import (
    JobPool,
    SlurmResources,
    in_shard,
    run_on_dask,
    run_on_slurm,
    serve_jobs,
    slurm_script,
)

ExecutorName = Literal["local", "slurm", "dask", "none"]
NO_RESOURCES: Final = SlurmResources()


@dataclass(frozen=True, slots=True)
class JobFolder(ABC):
    """Subclasses say what the jobs are; everything of one lies in ``folder``, which all machines see."""

    folder: Path
    job_name: ClassVar[str]
    """Of an array job."""

    @property
    @abstractmethod
    def worker_command(self) -> list[str]:
        """Starts a process that runs the jobs whose keys come on its standard input, as ``serve_keys`` does."""

    @property
    @abstractmethod
    def shard_command(self) -> list[str]:
        """Starts a process that runs the share of the jobs that ``--shard I/N`` behind it names."""

    @property
    def limit_s(self) -> float | None:
        """The time [s] after which a worker that is at one job counts as standing still; None: never."""
        return None

    @abstractmethod
    def keys(self) -> Sequence[str]:
        """The keys of all jobs, hexadecimal, each once, in the order in which they are run."""

    @abstractmethod
    def is_waiting(self, key: str) -> bool:
        """Whether a job has no result yet."""

    @abstractmethod
    def run_job(self, key: str) -> object:
        """Runs a job and saves its result. Raises OSError if it cannot be saved."""

    @abstractmethod
    def record_loss(self, key: str) -> None:
        """Saves that the worker of a job died every time it was tried, unless it had saved the result before."""

    def waiting(self, shard: tuple[int, int] = (0, 1)) -> tuple[str, ...]:
        """The keys of share i of n that have no result yet."""
        return tuple(key for key in self.keys() if in_shard(key, shard) and self.is_waiting(key))


@dataclass(frozen=True, slots=True)
class JobExecutor:
    """Where jobs run, and how many side by side."""

    name: ExecutorName = "local"
    """``none``: nowhere now."""
    jobs: int = 1
    """Processes, or tasks of an array job."""
    cluster: str = ""
    """Address of the Dask scheduler."""
    slurm: SlurmResources = NO_RESOURCES

    def run(self, folder: JobFolder, keys: Sequence[str], on_done: Callable[[str], object]) -> None:
        """Runs these jobs. ``on_done``: called with each key that is through; on SLURM, which is waited for, never.

        Raises ExecutorUnavailable, KeyboardInterrupt, and OSError if results cannot be saved.
        """
        if self.name == "none" or not keys:
            return
        if self.name == "slurm":
            script = slurm_script(folder.folder, folder.shard_command, self.jobs, folder.job_name, self.slurm)
            run_on_slurm(folder.folder, script, lambda: bool(folder.waiting()))
        elif self.name == "dask":
            run_one = partial(_run_one, type(folder))
            run_on_dask(
                folder.folder, run_one, keys, self.cluster, on_done, folder.record_loss, folder.limit_s
            )
        else:
            JobPool(folder.worker_command, keys, self.jobs, on_done, folder.record_loss, folder.limit_s).run()


def _run_one(kind: type[JobFolder], folder: str, key: str) -> None:
    """Runs one job, given by names alone, as Dask sends them."""
    kind(Path(folder)).run_job(key)


def serve_keys(run_job: Callable[[str], object]) -> None:
    """Runs the jobs whose keys come on standard input. Whatever else is printed goes to standard error: it must not mix with
    the answers. A result that cannot be saved ends the process, with a sentence; whoever started it tries once more."""
    answers = os.fdopen(os.dup(sys.stdout.fileno()), "w")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())
    try:
        serve_jobs(run_job, sys.stdin, answers)
    except (BrokenPipeError, KeyboardInterrupt):  # the process that started this one has ended, or ends it
        raise SystemExit(1) from None
    except OSError as error:
        raise SystemExit(f"{error.filename or 'a result'}: {error.strerror or error}") from None
