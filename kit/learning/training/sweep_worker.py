"""The process that runs trainings of a sweep.

``python -m kit.learning.training.sweep_worker FOLDER`` runs those whose keys come on standard input; with ``--shard I/N``
those of a share that have no result yet, one after the other. A signal to end, or the end of the process that started this one, leaves a checkpoint of the training that runs.
"""

from __future__ import annotations

import os
import signal
import sys
from functools import partial
from pathlib import Path

from kit.host.job_executors import read_shard, serve_jobs
from kit.learning.training.training_sweep import TrainingSweep
from kit.learning.training.worker import EXIT_SIGNALS, ExitRequest


def run_job_by_key(folder: str, key: str) -> str:
    """Runs one training, given by strings alone, as Dask sends them."""
    TrainingSweep(Path(folder)).run_job(key)
    return key


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
        elif len(arguments) == 1:
            # Other output must not mix with the answers.
            answers = os.fdopen(os.dup(sys.stdout.fileno()), "w")
            os.dup2(sys.stderr.fileno(), sys.stdout.fileno())
            serve_jobs(run_job, sys.stdin, answers)
        else:
            sys.stderr.write("usage: python -m kit.learning.training.sweep_worker FOLDER [--shard I/N]\n")
            return 2
    except KeyboardInterrupt:
        return 130
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
