"""The process that runs trainings of a sweep.

``python -m kit.learning.training.sweep_worker FOLDER`` runs those whose keys come on standard input; with ``--shard I/N``
those of a share that have no result yet, one after the other; with ``--all``, as ``start_sweep`` starts it in a session of its
own, all that have none, in processes side by side. A signal to end, or the end of the process that started this one, leaves a
checkpoint of the training that runs.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Final

from kit.host.job_executors import read_shard
from kit.host.job_folder import JobExecutor, serve_keys
from kit.learning.training.process_lock import LockedError
from kit.learning.training.training_sweep import TrainingSweep
from kit.learning.training.worker import EXIT_SIGNALS, ExitRequest

PATIENCE_S: Final = 30.0
"""Longest time for a sweep's process to start [s]."""


def start_sweep(sweep: TrainingSweep) -> subprocess.Popen[bytes]:
    """Starts a process that trains all that has no result yet, and outlives this one; it ends at once where another one
    does. The caller need not wait for it."""
    with (sweep.folder / "log.txt").open("wb") as log:
        process = subprocess.Popen(
            [*sweep.worker_command, "--all"],
            stdin=subprocess.DEVNULL,
            stdout=log,
            stderr=log,
            start_new_session=True,
        )
    until = time.monotonic() + PATIENCE_S
    while process.poll() is None and not sweep.is_active and time.monotonic() < until:
        time.sleep(0.02)
    return process


def _run_all(sweep: TrainingSweep) -> int:
    """Trains all that has no result yet, unless another process does."""
    signal.signal(signal.SIGHUP, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    with suppress(LockedError), sweep.kept_from_others():
        JobExecutor(jobs=_available_processors()).run(sweep, sweep.waiting(), lambda key: None)
    return 0


def _available_processors() -> int:
    """How many processors this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def main(arguments: list[str]) -> int:
    asked, parent = ExitRequest(), os.getppid()
    for number in EXIT_SIGNALS:
        signal.signal(number, asked)
    sweep = TrainingSweep(Path(arguments[0]))
    run_job = partial(sweep.run_job, interrupted=lambda: asked.to_end or os.getppid() != parent)
    try:
        if len(arguments) == 3 and arguments[1] == "--shard" and (shard := read_shard(arguments[2])):
            for key in sweep.waiting(shard):
                run_job(key)
        elif arguments[1:] == ["--all"]:
            return _run_all(sweep)
        elif len(arguments) == 1:
            serve_keys(run_job)
        else:
            sys.stderr.write(
                "usage: python -m kit.learning.training.sweep_worker FOLDER [--shard I/N | --all]\n"
            )
            return 2
    except KeyboardInterrupt:
        return 130
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
