"""Processes of the grader that read a world or a task that was handed in, and are ended when they take too long."""

from __future__ import annotations

import contextlib
import json
import math
import os
import select
import signal
import subprocess
import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Self

from grader.evidence.world.facts import RunFacts, WorldFacts, WorldRunSpec
from grader.submitted_files import SubmissionUnreadable
from kit.host.failure import Failure, FailureKind, StudentCodeError
from kit.host.private_folder import make_private_folder
from kit.host.python_command import python_command
from kit.host.sandbox.confinement import INTERACTIVE_LEVEL, Level
from kit.host.sandbox.limits import GIB
from kit.host.sandbox.reaper import remove_folder
from kit.host.wire import printable

if TYPE_CHECKING:
    from grader.evidence.submission_clock import SubmissionClock
    from grader.evidence.training_results import PosedTaskPlan

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
        """Returns the next answer. ``slow``: the failure after so many seconds of wall clock."""
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


LONGEST_S: Final = 24 * 3600.0
"""Seconds for one answer where a submission has no limit."""


@dataclass(frozen=True, slots=True)
class PosedMeasure:
    """The measured value of one check."""

    value: float
    explanation: str = ""
    """For the student; may be empty."""
    picture: str = ""
    """Picture in plain characters; may be empty."""


class PosedTaskProcess(ReaderProcess):
    """One task in a process of its own. What a check measures is worked out when it is first asked for."""

    def __init__(
        self,
        file: Path,
        plan: PosedTaskPlan,
        seed: int,
        level: Level,
        clock: SubmissionClock,
        memory: int = MEMORY_LIMIT,
    ) -> None:
        super().__init__(
            "grader.evidence.posed_task_child",
            file,
            subject="task or its world",
            advice="Look at it with the kit (`kit task check`)",
            memory=memory,
            level=level,
        )
        self._clock = clock
        self._found: dict[tuple[str, tuple[str, ...]], PosedMeasure] = {}
        self._send({"plan": asdict(plan), "seed": seed})

    def read_task(self) -> str:
        """Returns what is wrong with the task; empty if nothing is. To be called first, and once."""
        self._clock.show_progress("reading the task and its world")
        return printable(str(self._answer()["problem"]))

    def measure(self, check: str, params: Mapping[str, str]) -> PosedMeasure:
        """Measures what a check asks for, by its name and parameters."""
        key = check, tuple(params.values())
        if key not in self._found:
            self._send({"check": check, "params": dict(params)})
            answer = self._answer()
            pictured = "\n".join(map(printable, str(answer["picture"]).split("\n")))
            value = float(answer["value"])
            self._found[key] = PosedMeasure(value, printable(str(answer["explanation"])), pictured)
        return self._found[key]

    def _answer(self) -> Mapping[str, Any]:
        seconds = LONGEST_S if math.isinf(self._clock.left_s) else self._clock.left_s
        slow = self._clock.used_up_failure()
        try:
            return self._await_answer(seconds, slow, self._clock.show_progress)
        except StudentCodeError:
            self.close()
            raise


READ_TIMEOUT_S: Final = 30.0
"""Seconds to read a world, including the start on a busy machine."""


class WorldProcess(ReaderProcess):
    """One world in a process of its own."""

    def __init__(
        self,
        file: Path,
        memory: int = MEMORY_LIMIT,
        level: Level = INTERACTIVE_LEVEL,
        drivers: Iterable[str] = (),
    ) -> None:
        """``drivers``: the files of the assignment's programs that will drive in it."""
        super().__init__(
            "grader.evidence.world.child",
            file,
            subject="world",
            advice="Open it with the kit (`kit world check`)",
            memory=memory,
            level=level,
            words=sorted(set(drivers) - {""}),
        )

    def read_world(self, seconds: float = READ_TIMEOUT_S) -> WorldFacts:
        """Returns what was read; to be called first, and once."""
        return WorldFacts.from_json(
            self._await_answer(seconds, _too_slow("The world takes too long to read"))
        )

    def run(self, spec: WorldRunSpec, seconds: float) -> RunFacts:
        """Makes one run within this many seconds of wall clock."""
        self._send(asdict(spec))
        slow = f"{spec.time_s:g} simulated seconds of this world take longer than {seconds:g} s"
        return RunFacts.from_json(self._await_answer(seconds, _too_slow(slow)))


def _too_slow(text: str) -> Failure:
    return Failure(FailureKind.TIMEOUT, f"{text}: it has too many walls, rays or bodies.")
