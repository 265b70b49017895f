"""Starts the process that reads and runs a world, and ends it when it takes too long."""

from __future__ import annotations

import contextlib
import json
import os
import select
import signal
import subprocess
import sys
import time
from collections.abc import Iterable, Mapping
from dataclasses import asdict
from pathlib import Path
from types import TracebackType
from typing import Any, Final, Self

from grader.evidence.world.facts import RunFacts, WorldFacts, WorldRunSpec
from grader.submitted_files import SubmissionUnreadable
from kit.host.failure import Failure, FailureKind, StudentCodeError
from kit.host.private_folder import make_private_folder
from kit.host.sandbox.confinement import INTERACTIVE_LEVEL, Level
from kit.host.sandbox.limits import GIB
from kit.host.sandbox.reaper import remove_folder

_CONFINED: Final = "confined"
"""The word on the process's command line that has it confine itself."""
READ_TIMEOUT_S: Final = 30.0
"""Seconds to read a world, including the start on a busy machine."""
MEMORY_LIMIT: Final = 4 * GIB
"""Bytes of address space, most of which the simulator only reserves."""
MAX_ANSWER_BYTES: Final = 64_000_000
"""Bytes."""
MAX_ERROR: Final = 200
"""Characters of an error's text for the teacher."""


class WorldProcess:
    """One world in a process of its own. Every method raises StudentCodeError when it takes too much time or memory."""

    def __init__(
        self,
        file: Path,
        memory: int = MEMORY_LIMIT,
        level: Level = INTERACTIVE_LEVEL,
        drivers: Iterable[str] = (),
    ) -> None:
        """``drivers``: the files of the assignment's programs that will drive in it."""
        self._folder = make_private_folder()
        confined = _CONFINED if level >= Level.FILTERED else ""
        words = [str(file.absolute()), str(memory), confined, self._folder, *sorted(set(drivers) - {""})]
        self._child = subprocess.Popen(
            [sys.executable, "-P", "-m", "grader.evidence.world.child", *words],
            env={**os.environ, "TMPDIR": self._folder},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            start_new_session=True,
        )
        self._rest = b""

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def read_world(self, seconds: float = READ_TIMEOUT_S) -> WorldFacts:
        """Returns what was read; to be called first, and once."""
        return WorldFacts.from_json(self._await_answer(seconds, "The world takes too long to read"))

    def run(self, spec: WorldRunSpec, seconds: float) -> RunFacts:
        """Makes one run within this many seconds of wall clock."""
        assert self._child.stdin is not None
        try:
            self._child.stdin.write(json.dumps(asdict(spec)).encode() + b"\n")
            self._child.stdin.flush()
        except OSError:
            raise self._exit_error() from None
        slow = f"{spec.time_s:g} simulated seconds of this world take longer than {seconds:g} s"
        return RunFacts.from_json(self._await_answer(seconds, slow))

    def close(self) -> None:
        """Ends the process and its children. May be called twice."""
        if self._child.poll() is None:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(self._child.pid, signal.SIGKILL)
        for pipe in (self._child.stdin, self._child.stdout, self._child.stderr):
            if pipe is not None:
                with contextlib.suppress(OSError):
                    pipe.close()
        self._child.wait()
        remove_folder(self._folder)

    def _await_answer(self, seconds: float, slow: str) -> Mapping[str, Any]:
        assert self._child.stdout is not None
        end = time.monotonic() + seconds
        handle = self._child.stdout.fileno()
        while b"\n" not in self._rest:
            left = end - time.monotonic()
            if left <= 0 or not select.select([handle], [], [], left)[0]:
                self.close()
                raise StudentCodeError(
                    Failure(FailureKind.TIMEOUT, f"{slow}: it has too many walls, rays or bodies.")
                )
            more = os.read(handle, 1 << 20)
            if not more or len(self._rest) > MAX_ANSWER_BYTES:
                raise self._exit_error()
            self._rest += more
        line, _, self._rest = self._rest.partition(b"\n")
        answer: Mapping[str, Any] = json.loads(line)
        return answer

    def _exit_error(self) -> BaseException:
        """Returns the error for an ended process: out of memory, or whatever this world has brought to light in it."""
        assert self._child.stderr is not None
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._child.wait(5)
        output = b"" if self._child.poll() is None else self._child.stderr.read(1 << 16)
        self.close()
        message = output.decode("utf-8", "replace").strip()
        if (
            "MemoryError" in message
            or "ArrayMemoryError" in message
            or self._child.returncode == -signal.SIGKILL
        ):
            return StudentCodeError(Failure(FailureKind.MEMORY, "The world needs too much memory."))
        last = message.splitlines()[-1:] or [f"it has ended with {self._child.returncode}"]
        return SubmissionUnreadable(
            "The world cannot be used: reading or running it ended with an error that is not foreseen. Open it with the "
            "kit (`kit world check`), and hand it in again.",
            f"the process that reads and runs worlds: {last[0][:MAX_ERROR]}",
        )
