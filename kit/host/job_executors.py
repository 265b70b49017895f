"""Works through jobs that are known by their keys: in local processes, in a SLURM array job, or on a Dask cluster.

A job's result is a file that all machines see (``JobFolder``), so that only keys are sent. What lies there as a result counts
only if its reader accepts it: a worker may have another version, a full disk, or a fault.
"""

from __future__ import annotations

import json
import math
import re
import shlex
import shutil
import signal
import subprocess
import threading
import time
from collections import deque
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, fields
from pathlib import Path
from typing import IO, Any, Final, NoReturn

from kit.installation import install_command
from kit.plain_files import read_plain_file
from kit.plain_text import quoted, suggestion
from kit.workspace import write_atomically

DONE: Final = "done"
MAX_TRIES: Final = 2
"""How often a job is tried whose worker dies."""
STOP_S: Final = 30.0
"""How long workers that are asked to end may take, to save what they have, before they are killed [s]."""
MAX_RESULT_BYTES: Final = 16_000_000
"""Bytes of a result's file, many times those of the longest."""
SLURM_SCRIPT: Final = "slurm.sh"


class ExecutorUnavailable(Exception):
    """This machine lacks what an executor needs; the message says what to do."""


def serve_jobs(run_job: Callable[[str], object], keys: IO[str], output: IO[str]) -> None:
    """Runs the job of the key on each input line, and writes the key to the output when its result is saved."""
    for line in keys:
        key = line.strip()
        run_job(key)
        output.write(f"{DONE} {key}\n")
        output.flush()


def read_result(file: Path) -> dict[str, Any]:
    """Returns the JSON object that a worker has saved. Raises ValueError or OSError for anything else, such as a number that
    is not finite, a larger file, or one that is none."""
    try:
        content = json.loads(read_plain_file(file, MAX_RESULT_BYTES), parse_constant=_refuse_constant)
        json.dumps(content, allow_nan=False)  # 1e999 is read as infinity
    except RecursionError:
        raise ValueError("it is nested too deeply") from None
    if type(content) is not dict:
        raise ValueError("it is not an object")
    return content


def _refuse_constant(name: str) -> NoReturn:
    raise ValueError(f"{name} is not a number of JSON")


def read_shard(text: str) -> tuple[int, int] | None:
    """Share i of n, from 0, as in ``0/4``; None if the text is something else."""
    found = re.fullmatch(r"(\d{1,6})/(\d{1,6})", text)
    if found is None or not int(found[1]) < int(found[2]):
        return None
    return int(found[1]), int(found[2])


def in_shard(key: str, shard: tuple[int, int]) -> bool:
    """Whether the job with a hexadecimal key belongs to share i of n."""
    number, count = shard
    return int(key, 16) % count == number


class JobPool:
    """Runs ``jobs`` worker processes. A worker that dies, or stands still, costs its job one try and nothing else."""

    def __init__(
        self,
        command: Sequence[str],
        keys: Sequence[str],
        jobs: int,
        on_done: Callable[[str], object],
        on_lost: Callable[[str], object],
        limit_s: float | None = None,
    ) -> None:
        """``command`` starts a worker, which calls ``serve_jobs`` on its standard streams. ``on_done``: called with each key
        that is through, by one thread at a time; ``on_lost``: before it, with the key of a job whose worker died every
        time. ``limit_s``: after this long [s] a worker that is at one job counts as standing still."""
        self._command = tuple(command)
        self._waiting = deque(keys)
        self._jobs = min(jobs, len(keys))
        self._on_done = on_done
        self._on_lost = on_lost
        self._limit_s = limit_s
        self._lock = threading.Lock()
        self._problems: list[Exception] = []
        self._workers: set[subprocess.Popen[str]] = set()
        self._is_stopped = False

    def run(self) -> None:
        """Runs until every key is through. Raises OSError if results cannot be saved; ends the workers if interrupted, at a
        second interruption at once."""
        # Not ``Thread.join``: before Python 3.13 a thread counts as ended where waiting for it was interrupted.
        ends = [threading.Event() for _ in range(self._jobs)]
        for end in ends:
            threading.Thread(target=self._run_worker, args=(end,)).start()
        try:
            _wait_for(ends)
        except BaseException:
            self._is_stopped = True
            self._signal_workers(signal.SIGTERM)
            try:
                _wait_for(ends, STOP_S)
            finally:
                self._signal_workers(signal.SIGKILL)
                _wait_for(ends)
            raise
        if self._problems:
            raise self._problems[0]

    def _signal_workers(self, number: signal.Signals) -> None:
        for worker in tuple(self._workers):
            worker.send_signal(number)

    def _run_worker(self, end: threading.Event) -> None:
        """Feeds keys to one worker process, and replaces it when it dies. Sets ``end`` once all is over."""
        worker: subprocess.Popen[str] | None = None
        try:
            while (key := self._next()) is not None:
                for attempt in range(MAX_TRIES):
                    worker = worker or self._start()
                    self._workers.add(worker)
                    if self._is_stopped:  # while it was started: nobody else ends it
                        return
                    if self._is_done(worker, key):
                        break
                    self._workers.discard(worker)
                    _stop_worker(worker, now=True)
                    worker = None
                    if self._is_stopped:
                        return
                    if attempt == MAX_TRIES - 1:
                        self._on_lost(key)
                with self._lock:
                    self._on_done(key)
        except Exception as error:  # noqa: BLE001  # a thread's error is raised where the threads were started
            self._problems.append(error)
        finally:
            try:
                if worker is not None:
                    _stop_worker(worker)
            finally:
                end.set()

    def _next(self) -> str | None:
        with self._lock:
            is_over = self._problems or self._is_stopped
            return self._waiting.popleft() if self._waiting and not is_over else None

    def _start(self) -> subprocess.Popen[str]:
        return subprocess.Popen(self._command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def _is_done(self, worker: subprocess.Popen[str], key: str) -> bool:
        assert worker.stdin is not None
        assert worker.stdout is not None
        try:
            worker.stdin.write(f"{key}\n")
            worker.stdin.flush()
        except BrokenPipeError:
            return False
        if self._limit_s is None:
            return worker.stdout.readline() == f"{DONE} {key}\n"
        # A job has limits of its own; this is for a worker that stands still itself.
        watchdog = threading.Timer(self._limit_s, worker.kill)
        watchdog.daemon = True
        watchdog.start()
        try:
            return worker.stdout.readline() == f"{DONE} {key}\n"
        finally:
            watchdog.cancel()


def _wait_for(ends: Sequence[threading.Event], limit_s: float = math.inf) -> None:
    """Waits until all are set, or so long."""
    until = time.monotonic() + limit_s
    for end in ends:
        end.wait(min(max(0.0, until - time.monotonic()), threading.TIMEOUT_MAX))


def _stop_worker(worker: subprocess.Popen[str], *, now: bool = False) -> None:
    """Closes a worker's input, so that it ends; with ``now``, kills it first."""
    if now:
        worker.kill()
    with worker, suppress(BrokenPipeError):
        assert worker.stdin is not None
        worker.stdin.close()


@dataclass(frozen=True, slots=True)
class SlurmResources:
    """What a task of an array job asks the cluster for; an empty text leaves it to the cluster."""

    account: str = ""
    partition: str = ""
    qos: str = ""
    time: str = "04:00:00"
    memory: str = "4G"

    @classmethod
    def read(cls, given: Sequence[str]) -> SlurmResources:
        """Reads texts ``NAME=VALUE``. Raises ValueError for another name, and for a value that would end the line of a script.

        >>> SlurmResources.read(["account=robots", "time=08:00:00"]).time
        '08:00:00'
        """
        names = [each.name for each in fields(cls)]
        values = {}
        for text in given:
            name, _, value = text.partition("=")
            if name not in names:
                raise ValueError(f"{quoted(text)}: {suggestion(name, names)}; write it as NAME=VALUE")
            if not _SLURM_VALUE.fullmatch(value):
                raise ValueError(f"{quoted(text)}: the value has letters, digits and _ . : , @ + - alone")
            values[name] = value
        return cls(**values)

    def lines(self) -> str:
        """The lines of a script that ask for them."""
        asked = {
            "account": self.account,
            "partition": self.partition,
            "qos": self.qos,
            "time": self.time,
            "mem": self.memory,
        }
        return "".join(f"#SBATCH --{name}={value}\n" for name, value in asked.items() if value)


_SLURM_VALUE: Final = re.compile(r"[A-Za-z0-9_.:,@+-]+")


def slurm_script(
    folder: Path, command: Sequence[str], shards: int, name: str, resources: SlurmResources | None = None
) -> str:
    """Returns the script of an array job ``name`` of ``shards`` tasks, each of which runs ``command --shard I/N``."""
    asked = (resources or SlurmResources()).lines()
    return f"""#!/bin/sh
#SBATCH --job-name={name}
#SBATCH --array=0-{shards - 1}
#SBATCH --cpus-per-task=2
{asked}#SBATCH --output={shlex.quote(str(folder.absolute()))}/slurm-%a.log
exec {shlex.join(command)} --shard "$SLURM_ARRAY_TASK_ID/{shards}"
"""


def run_on_slurm(folder: Path, script_text: str, is_waiting: Callable[[], bool]) -> None:
    """Submits the array job, with its script in ``folder``, and waits until it is over. Raises ExecutorUnavailable."""
    script = folder / SLURM_SCRIPT
    write_atomically(script, script_text.encode())
    sbatch = shutil.which("sbatch")
    if sbatch is None:
        raise ExecutorUnavailable(f"There is no sbatch here. On the cluster's front end run: sbatch {script}")
    done = subprocess.run([sbatch, "--wait", str(script)], capture_output=True, text=True, check=False)
    if done.returncode != 0 and is_waiting():
        said = done.stderr.strip()[:300]
        if not said:
            raise ExecutorUnavailable(
                "The array job has ended with jobs left, as where a task was killed: run the same command to go on. What the "
                f"tasks said: {folder}/slurm-*.log"
            )
        raise ExecutorUnavailable(
            f"sbatch failed: {said}. Accounts, partitions and limits are given with --slurm; the script: {script}"
        )


def run_on_dask(
    folder: Path,
    run_job_by_key: Callable[[str, str], object],
    keys: Sequence[str],
    address: str,
    on_done: Callable[[str], object],
    on_lost: Callable[[str], object],
    limit_s: float | None = None,
) -> None:
    """Runs the jobs on a Dask cluster whose machines all see the folder. Raises ExecutorUnavailable, after all other jobs are
    through, if one failed.

    ``run_job_by_key`` gets the folder and a key. ``on_lost``: called with the key of a job that repeatedly kills its
    worker. ``limit_s``: if no job at all ends for this long [s], the cluster counts as standing still.
    """
    try:
        from distributed import Client, KilledWorker, wait
    except ImportError:
        raise ExecutorUnavailable(
            f"Dask is not installed. To have it, type: {install_command('cluster')}"
        ) from None
    if not address:
        raise ExecutorUnavailable("Give the address of the Dask scheduler: --cluster tcp://HOST:8786")
    where = str(folder.absolute())
    with Client(address) as client:
        futures = {
            client.submit(run_job_by_key, where, key, pure=False, retries=MAX_TRIES - 1): key for key in keys
        }
        failed: dict[str, Exception] = {}
        while futures:
            try:
                over = wait(list(futures), timeout=limit_s, return_when="FIRST_COMPLETED").done
            except TimeoutError:
                raise ExecutorUnavailable(
                    f"No job has ended on the cluster for {limit_s:.0f} s: does the scheduler have workers? Results so far "
                    "are kept; run the same command to continue."
                ) from None
            for future in over:
                key = futures.pop(future)
                problem = _problem_of(future)
                if isinstance(problem, KilledWorker):
                    on_lost(key)
                elif problem is not None:
                    failed[key] = problem
                on_done(key)
    if failed:
        first = next(iter(failed.values()))
        raise ExecutorUnavailable(
            f"{len(failed)} of {len(keys)} jobs failed on the cluster, the first with {type(first).__name__}: "
            f"{quoted(str(first), 200)}. The other results are kept; run the same command to try these again."
        )


def _problem_of(future: Any) -> Exception | None:
    """Returns what a task ended with; also what went wrong while that was fetched."""
    try:
        problem: Exception | None = future.exception()
    except Exception as error:  # noqa: BLE001 - it was cancelled, or its error cannot be read on this machine
        return error
    return problem
