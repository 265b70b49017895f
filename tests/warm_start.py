"""Students' processes are forked from a warm interpreter, which takes a third of the work of starting one.

What is forked has the modules, descriptors, environment and parent of what would have been started. A test that looks at the
start itself asks for the fixture ``cold_start``; with ``KIT_TESTS_COLD`` in the environment every process is started, as for
users: ``.ci/run`` does that.
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
from contextlib import contextmanager
from pathlib import Path
from types import SimpleNamespace
from typing import IO, Any, Final
from unittest.mock import patch

from kit.host import process

CLONE_CALLS: Final = {"x86_64": 56, "aarch64": 220}
"""The number of Linux's system call ``clone``, by machine."""
_SERVE: Final = (
    "import sys; sys.path.insert(0, {root!r}); "
    "from kit.host.child import supervisor; from tests.warm_interpreter import serve; "
    "del sys.path[0], sys.modules['tests'], sys.modules['tests.warm_interpreter']; "
    "serve({call})"
)


def is_possible() -> bool:
    """Returns whether this machine can fork a process beside another."""
    return sys.platform == "linux" and platform.machine() in CLONE_CALLS


@contextmanager
def warm_starts() -> Iterator[None]:
    """Has students' processes be forked. Not for two threads at once."""
    with WarmInterpreter() as interpreter:
        stand_in = SimpleNamespace(
            Popen=interpreter.start, PIPE=subprocess.PIPE, TimeoutExpired=subprocess.TimeoutExpired
        )
        with patch.object(process, "subprocess", stand_in):
            yield


@contextmanager
def cold_starts() -> Iterator[None]:
    """Has students' processes be started after all."""
    with patch.object(process, "subprocess", subprocess):
        yield


class ForkedProcess:
    """Stands in for a ``subprocess.Popen`` with what ``StudentProcess`` uses of it."""

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
        self._command = process.interpreter_command()
        serving = _SERVE.format(root=str(Path(__file__).parents[1]), call=CLONE_CALLS[platform.machine()])
        self._requests, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        with theirs:
            self._process = subprocess.Popen(
                [*self._command[:-1], serving],
                stdin=theirs,
                stdout=subprocess.DEVNULL,
                cwd="/",
                env=process.process_environment("/"),
                start_new_session=True,
            )

    def __enter__(self) -> WarmInterpreter:
        return self

    def __exit__(self, *_: object) -> None:
        self._requests.close()
        self._process.wait()

    def start(
        self,
        command: Sequence[str],
        *,
        stdin: int,
        cwd: str,
        env: Mapping[str, str],
        pass_fds: Sequence[int],
        **options: Any,
    ) -> ForkedProcess | subprocess.Popen[bytes]:
        """Forks a process in place of ``subprocess.Popen``, which starts what is no plain process of a student's. So it does in a
        fork of the tests' process, which would not be the parent of what is forked."""
        if command != self._command or pass_fds or os.getpid() != self._owner:
            return subprocess.Popen(command, stdin=stdin, cwd=cwd, env=env, pass_fds=pass_fds, **options)
        out, err = os.pipe(), os.pipe()
        request = json.dumps([cwd, dict(env)]).encode()
        passed = array.array("i", [stdin, out[1], err[1]])
        with self._lock:
            self._requests.sendmsg([request], [(socket.SOL_SOCKET, socket.SCM_RIGHTS, passed)])
            pid = int(self._requests.recv(64))
        os.close(out[1])
        os.close(err[1])
        return ForkedProcess(pid, out[0], err[0])
