"""The process that trains one run: detached, so that it outlives the user interface and a dropped SSH connection.

``python -m kit.learning.training.worker FOLDER`` trains in the foreground; ``start_worker`` starts that in a session of its own.
"""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from pathlib import Path
from types import FrameType

from kit.host.python_command import python_command
from kit.learning.training.learn_extra import LearnExtraMissing
from kit.learning.training.run_config import RunError
from kit.learning.training.runs import TrainingRun

EXIT_SIGNALS = (signal.SIGTERM, signal.SIGINT)
START_S = 30.0
"""The longest wait [s] until a process has taken over its run."""


class ExitRequest:
    """Remembers that the system or the user wants this process to end."""

    def __init__(self) -> None:
        self.to_end = False

    def __call__(self, number: int, frame: FrameType | None) -> None:
        self.to_end = True


def run_worker(run: TrainingRun) -> int:
    """Trains the run in this process; the exit code: 0 it has ended or was left to go on later, 1 it failed.

    A signal to end leaves a checkpoint; that terminals close (SIGHUP) is ignored.
    """
    asked = ExitRequest()
    for number in EXIT_SIGNALS:
        signal.signal(number, asked)
    signal.signal(signal.SIGHUP, signal.SIG_IGN)
    from kit.learning.training.training import train

    try:
        ended = train(run, interrupted=lambda: asked.to_end)
    except KeyboardInterrupt:
        _write_error(f"{run.name}: stopped here. `kit train --resume {run.name}` continues it.")
        return 0
    except OSError as error:  # before there was anything to lose: later ones end the run as failed
        _write_error(
            f"{error.filename or run.folder}: {error.strerror or error}. {run.name} cannot be trained there."
        )
        return 1
    except (RunError, LearnExtraMissing) as error:
        _write_error(error)
        return 1
    if ended.how == "failed":
        _write_error(ended.reason)
    return int(ended.how == "failed")


def start_worker(run: TrainingRun) -> subprocess.Popen[bytes]:
    """Starts a process that trains the run, and waits until it has taken it over, up to ``START_S`` seconds.

    RunError, with what the process printed, if it ends before it has begun. The caller need not wait for it.
    """
    run.send_command("go")
    with run.log.open("wb") as log:
        process = subprocess.Popen(
            python_command("kit.learning.training.worker", str(run.folder)),
            stdin=subprocess.DEVNULL,
            stdout=log,
            stderr=log,
            cwd=run.folder,
            start_new_session=True,
        )
    until = time.monotonic() + START_S
    while process.poll() is None and not run.is_active and time.monotonic() < until:
        time.sleep(0.02)
    if process.poll() not in (None, 0):
        output = run.log.read_text(errors="replace").strip()
        raise RunError(output or f"{run.name}: training could not start; see {run.log}.")
    return process


def _write_error(message: object) -> None:
    sys.stderr.write(f"{message}\n")


def main(arguments: list[str]) -> int:
    if len(arguments) != 1:
        _write_error("usage: python -m kit.learning.training.worker FOLDER")
        return 2
    return run_worker(TrainingRun(Path(arguments[0])))


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
