"""A process of the grader that reads what was handed in, and is ended when it takes too long."""

from __future__ import annotations

import contextlib
import json
import os
import select
import signal
import subprocess
import time
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any, Final, Self

from grader.submitted_files import SubmissionUnreadable
from kit.host.failure import Failure, FailureKind, StudentCodeError
from kit.host.private_folder import make_private_folder
from kit.host.python_command import python_command
from kit.host.sandbox.limits import GIB
from kit.host.sandbox.reaper import remove_folder
from kit.host.sandbox.sandbox_config import INTERACTIVE_LEVEL, Level

_CONFINED: Final = "confined"
"""The word on the process's command line that has it confine itself."""

MEMORY_LIMIT: Final = 4 * GIB
"""Bytes of address space, most of which the simulator only reserves."""

MAX_ANSWER_BYTES: Final = 64_000_000
"""Bytes of one answer."""

MAX_ERROR: Final = 200
"""Characters of an error's text for the teacher."""

PROGRESS: Final = "progress"
"""The key of a line that is no answer, but says what the time is used for."""


class ReaderProcess:
    """A module of the grader's that reads a file in a process of its own: a line of JSON for each request, and one for
    each answer. Every method raises StudentCodeError when it takes too much time or memory."""

    def __init__(
        self,
        module: str,
        file: Path,
        *,
        subject: str,
        advice: str,
        memory: int = MEMORY_LIMIT,
        level: Level = INTERACTIVE_LEVEL,
        words: Iterable[str] = (),
    ) -> None:
        """``subject``: what the file is, in messages: ``world``. ``advice``: how the student may look at it. ``words``: what
        else stands on the command line of the module's ``main``."""
        self._subject = subject
        self._advice = advice
        self._folder = make_private_folder()
        confined = _CONFINED if level >= Level.FILTERED else ""
        self._child = subprocess.Popen(
            python_command(module, str(file.absolute()), str(memory), confined, self._folder, *words),
            env={**os.environ, "TMPDIR": self._folder},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            start_new_session=True,
        )
        self._rest = b""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

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

    def _send(self, request: Mapping[str, Any]) -> None:
        assert self._child.stdin is not None
        try:
            self._child.stdin.write(json.dumps(request).encode() + b"\n")
            self._child.stdin.flush()
        except OSError:
            raise self._exit_error() from None

    def _await_answer(
        self, seconds: float, slow: Failure, show_progress: Callable[[str], None] = lambda text: None
    ) -> Mapping[str, Any]:
        """Returns the next answer. ``slow``: the failure after this many seconds of wall clock."""
        end = time.monotonic() + seconds
        while True:
            answer: Mapping[str, Any] = json.loads(self._await_line(end, slow))
            if PROGRESS not in answer:
                return answer
            show_progress(str(answer[PROGRESS]))

    def _await_line(self, end: float, slow: Failure) -> bytes:
        assert self._child.stdout is not None
        handle = self._child.stdout.fileno()
        while b"\n" not in self._rest:
            left = end - time.monotonic()
            if left <= 0 or not select.select([handle], [], [], left)[0]:
                self.close()
                raise StudentCodeError(slow)
            more = os.read(handle, 1 << 20)
            if not more:
                raise self._exit_error()
            self._rest += more
            if len(self._rest) > MAX_ANSWER_BYTES:
                self.close()
                raise StudentCodeError(Failure(FailureKind.MEMORY, self._too_large()))
        line, _, self._rest = self._rest.partition(b"\n")
        return line

    def _too_large(self) -> str:
        return (
            f"The {self._subject} is too large: the facts about it take more than {MAX_ANSWER_BYTES // 1_000_000} MB. "
            f"{self._advice}, make it smaller, and hand it in again."
        )

    def _exit_error(self) -> BaseException:
        """Returns the error for an ended process: out of memory, or whatever this file has brought to light in it."""
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
            return StudentCodeError(
                Failure(FailureKind.MEMORY, f"The {self._subject} needs too much memory.")
            )
        last = message.splitlines()[-1:] or [f"it has ended with {self._child.returncode}"]
        return SubmissionUnreadable(
            f"The {self._subject} cannot be used: reading or running it ended with an unexpected error. "
            f"{self._advice}, and hand it in again.",
            f"the process that reads and runs it: {last[0][:MAX_ERROR]}",
        )
