"""Forks students' processes from a warm interpreter, which takes a third of the work of starting one.

For a student's own check, at level 0, and for tests. The interpreter belongs to one process of the kit and ends with it; it
has never held anything but the kit's own modules. What is forked has the descriptors, environment and parent of what would have
been started, and the modules that a program of any role may need.
"""

from __future__ import annotations

import array
import json
import os
import platform
import select
import signal
import socket
import subprocess
import sys
import threading
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO, Any, Final

from kit.host import program_start

CLONE_CALLS: Final = {"x86_64": 56, "aarch64": 220}
"""The number of Linux's system call ``clone``, by machine."""
_SERVE: Final = (
    f"import sys; sys.path.insert(0, {str(Path(__file__).parents[2])!r}); "
    "from kit.host.child import warm_interpreter; del sys.path[0]; warm_interpreter.serve({call})"
)


def is_possible() -> bool:
    """Returns whether this machine can fork a process beside another."""
    if sys.platform != "linux" or platform.machine() not in CLONE_CALLS:
        return False
    try:
        os.close(os.pidfd_open(os.getpid()))
    except OSError:  # an old kernel
        return False
    return True


@contextmanager
def warm_starts() -> Iterator[None]:
    """Has students' processes be forked, where this machine can. The interpreter starts at once, beside what follows."""
    if not is_possible():
        yield
        return
    with WarmInterpreter() as interpreter, program_start.started_by(interpreter.start):
        yield


class ForkedProcess:
    """A process that was forked, with what is used of a ``subprocess.Popen``."""

    def __init__(self, pid: int, stdout: int, stderr: int) -> None:
        self.pid = pid
        self.stdout: IO[bytes] = os.fdopen(stdout, "rb", 0)
        self.stderr: IO[bytes] = os.fdopen(stderr, "rb", 0)
        self._handle = os.pidfd_open(pid)
        self._status: int | None = None

    def wait(self, timeout: float | None = None) -> int:
        if self._status is None:
            if not select.select([self._handle], [], [], timeout)[0]:
                raise subprocess.TimeoutExpired("a forked process", timeout or 0.0)
            self._status = os.waitstatus_to_exitcode(os.waitpid(self.pid, 0)[1])
            os.close(self._handle)
        return self._status

    def kill(self) -> None:
        if self._status is None:
            signal.pidfd_send_signal(self._handle, signal.SIGKILL)


class WarmInterpreter:
    """An interpreter that forks students' processes. Use it as a context manager."""

    def __init__(self) -> None:
        self._lock, self._owner = threading.Lock(), os.getpid()
        self._command = program_start.interpreter_command()
        serving = _SERVE.replace("{call}", str(CLONE_CALLS[platform.machine()]))
        self._requests, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        with theirs:
            self._process = subprocess.Popen(
                [*self._command[:-1], serving],
                stdin=theirs.fileno(),
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                cwd="/",
                env=program_start.process_environment("/"),
                start_new_session=True,
            )

    def __enter__(self) -> WarmInterpreter:
        return self

    def __exit__(self, *_: object) -> None:
        with suppress(OSError):  # it has ended
            self._requests.shutdown(socket.SHUT_RDWR)  # a fork of this process may hold it open
        self._requests.close()
        self._process.wait()

    def start(
        self,
        command: list[str],
        *,
        stdin: int,
        cwd: str,
        env: Mapping[str, str],
        pass_fds: Sequence[int],
        **options: Any,
    ) -> program_start.StartedProcess:
        """Forks a process. What is no plain process of a student's is started, and so is what a fork of this process asks for,
        which would not be the parent of what is forked."""
        if command != self._command or pass_fds or os.getpid() != self._owner:
            return program_start.start_cold(
                command, stdin=stdin, cwd=cwd, env=env, pass_fds=pass_fds, **options
            )
        out, err = os.pipe(), os.pipe()
        request = json.dumps([cwd, dict(env)]).encode()
        passed = array.array("i", [stdin, out[1], err[1]])
        try:
            with self._lock:
                self._requests.sendmsg([request], [(socket.SOL_SOCKET, socket.SCM_RIGHTS, passed)])
                answer = self._requests.recv(64)
        except OSError:
            answer = b""
        os.close(out[1])
        os.close(err[1])
        if not answer:  # the interpreter has ended: not every kernel of such a version lets it fork
            os.close(out[0])
            os.close(err[0])
            return program_start.start_cold(
                command, stdin=stdin, cwd=cwd, env=env, pass_fds=pass_fds, **options
            )
        return ForkedProcess(int(answer), out[0], err[0])
