"""The process that trains one run: detached, so that it outlives the face and a dropped SSH connection.

``python -m kit.learning.training.worker FOLDER`` trains in the foreground; ``start`` starts that in a session of its own.
"""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from pathlib import Path
from types import FrameType

from kit.learning.training.runs import Run, RunError

ASK_TO_END = (signal.SIGTERM, signal.SIGINT)


class _Asked:
    """Remembers that the system or the user wants this process to end."""

    def __init__(self) -> None:
        self.to_end = False

    def __call__(self, number: int, frame: FrameType | None) -> None:
        self.to_end = True


def work(run: Run) -> int:
    """Trains the run in this process; the exit code: 0 it has ended or was left to go on later, 1 it failed.

    A signal to end leaves a checkpoint; that terminals close (SIGHUP) is ignored.
    """
    asked = _Asked()
    for number in ASK_TO_END:
        signal.signal(number, asked)
    signal.signal(signal.SIGHUP, signal.SIG_IGN)
    from kit.learning.training.optional_deps import LearnerMissing
    from kit.learning.training.training import train

    try:
        ended = train(run, interrupted=lambda: asked.to_end)
    except KeyboardInterrupt:
        _say(f"{run.name}: left where it is. `kit train --resume {run.name}` goes on.")
        return 0
    except (RunError, LearnerMissing) as error:
        _say(error)
        return 1
    if ended.how == "failed":
        _say(ended.reason)
    return int(ended.how == "failed")


def start(run: Run, *, patience: float = 30.0) -> subprocess.Popen[bytes]:
    """Starts a process that trains the run, and waits until it has taken it over, up to ``patience`` seconds.

    RunError, with what the process said, if it ends before it has begun. The caller need not wait for it.
    """
    run.ask("go")
    with run.log.open("wb") as log:
        process = subprocess.Popen(
            [sys.executable, "-m", "kit.learning.training.worker", str(run.folder)],
            stdin=subprocess.DEVNULL,
            stdout=log,
            stderr=log,
            cwd=run.folder,
            start_new_session=True,
        )
    until = time.monotonic() + patience
    while process.poll() is None and not run.alive and time.monotonic() < until:
        time.sleep(0.02)
    if process.poll() not in (None, 0):
        said = run.log.read_text(errors="replace").strip()
        raise RunError(said or f"{run.name}: training could not start; see {run.log}.")
    return process


def _say(message: object) -> None:
    sys.stderr.write(f"{message}\n")


def main(arguments: list[str]) -> int:
    if len(arguments) != 1:
        _say("usage: python -m kit.learning.training.worker FOLDER")
        return 2
    return work(Run(Path(arguments[0])))


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
