"""Executors that work through a queue: local processes, a SLURM job array, or a Dask cluster."""

from __future__ import annotations

import shlex
import shutil
import subprocess
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Final

from grader.cohort.queue import Queue
from grader.cohort.work import MAX_TRIES, WorkerPool, grade_job, record_incident
from kit.workspace import write_atomically

SLURM_SCRIPT: Final = "slurm.sh"


class ExecutorUnavailable(Exception):
    """This machine lacks what an executor needs; the message says what to do."""


def run_locally(queue: Queue, keys: Sequence[str], jobs: int, on_done: Callable[[str], None]) -> None:
    """Grades the jobs in processes on this machine."""
    WorkerPool(queue, keys, jobs, on_done).run()


def slurm_script(queue: Queue, shards: int) -> str:
    """Returns the script of an array job of ``shards`` tasks, each of which grades its share of the queue."""
    command = shlex.join([sys.executable, "-P", "-m", "grader", "work", str(queue.folder.absolute())])
    return f"""#!/bin/sh
#SBATCH --job-name=grader
#SBATCH --array=0-{shards - 1}
#SBATCH --cpus-per-task=2
#SBATCH --mem=4G
#SBATCH --time=04:00:00
#SBATCH --output={shlex.quote(str(queue.folder.absolute()))}/slurm-%a.log
exec {command} --shard "$SLURM_ARRAY_TASK_ID/{shards}"
"""


def run_on_slurm(queue: Queue, shards: int) -> None:
    """Submits the array job and waits until it is over. Raises ExecutorUnavailable."""
    script = queue.folder / SLURM_SCRIPT
    write_atomically(script, slurm_script(queue, shards).encode())
    sbatch = shutil.which("sbatch")
    if sbatch is None:
        raise ExecutorUnavailable(f"There is no sbatch here. On the cluster's front end run: sbatch {script}")
    done = subprocess.run([sbatch, "--wait", str(script)], capture_output=True, text=True, check=False)
    if done.returncode != 0 and queue.waiting():
        raise ExecutorUnavailable(f"sbatch failed: {done.stderr.strip()[:300] or done.returncode}")


def run_on_dask(queue: Queue, keys: Sequence[str], address: str, on_done: Callable[[str], None]) -> None:
    """Grades the jobs on a Dask cluster whose machines all see the queue folder. Raises ExecutorUnavailable.

    Only keys are sent. A job that repeatedly kills its worker gets no grade; the others go on.
    """
    try:
        from distributed import Client, KilledWorker, as_completed
    except ImportError:
        raise ExecutorUnavailable(
            "Dask is not installed. In the kit's folder: pip install -c constraints.txt -e '.[cluster]'"
        ) from None
    if not address:
        raise ExecutorUnavailable("Say where the Dask scheduler is: --cluster tcp://HOST:8786")
    folder = str(queue.folder.absolute())
    with Client(address) as client:
        futures = {
            client.submit(grade_job_by_key, folder, key, pure=False, retries=MAX_TRIES - 1): key
            for key in keys
        }
        for future in as_completed(futures):
            problem = future.exception()
            if isinstance(problem, KilledWorker):
                record_incident(queue, futures[future])
            elif problem is not None:
                raise ExecutorUnavailable(
                    f"A worker of the cluster could not grade: {type(problem).__name__}: {problem}"
                )
            on_done(futures[future])


def grade_job_by_key(folder: str, key: str) -> str:
    """Grades one job, given by strings alone, as Dask sends them."""
    grade_job(Queue(Path(folder)), key)
    return key
