"""Running processes of a launch: a program of a package, a command, or something the kit has itself."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Final, Literal, NamedTuple, Protocol

from kit.host.failure import Failure, GuestError
from kit.host.node_process import Guest
from kit.host.wire import printable
from kit.ros.node.node import Node

FAREWELL_S: Final = 2.0
"""How long a command has to end after it was asked to."""

LONGEST_LINE: Final = 4000


class Printed(NamedTuple):
    """A line that a process has printed."""

    text: str
    stream: Literal["out", "err"]


class Ended(NamedTuple):
    """How a process has ended: its exit code, and in words if that says more."""

    code: int
    reason: str = ""


class Process(Protocol):
    """Something a launch has started. ``poll`` is called between ticks and never waits."""

    pid: int
    is_ours: bool
    """Whether it is the kit's own, and so never ends by itself."""

    def poll(self) -> Ended | None:
        """How it has ended; None while it runs."""

    def take_lines(self) -> list[Printed]:
        """What it has printed since the last time."""

    def wait_until_started(self) -> None:
        """Until it is in the graph, or has failed to be."""

    @property
    def wake_ns(self) -> int | None:
        """When it wants to go on by itself [the graph's time]; None: only when something is said."""

    def exchange(self) -> bool:
        """As a runner's guest."""

    def close(self) -> None:
        """Ends it. May be called twice."""


class GuestProcess:
    """A node program: a guest that joins as soon as it has started."""

    is_ours = False

    def __init__(self, guest: Guest) -> None:
        self._guest = guest
        self._has_joined = False
        self._failure: Failure | None = None
        self.pid = guest.pid

    def poll(self) -> Ended | None:
        if not self._has_joined and self._failure is None:
            try:
                if self._guest.is_started():
                    self._join()
            except GuestError as error:
                self._failure = error.failure
        failure = self._failure or self._guest.failure
        if failure is not None:
            return Ended(1, str(failure))
        return Ended(0) if self._guest.has_ended else None

    def wait_until_started(self) -> None:
        if not self._has_joined and self._failure is None:
            try:
                self._guest.wait_until_started()
                self._join()
            except GuestError as error:
                self._failure = error.failure

    def take_lines(self) -> list[Printed]:
        printed = self._guest.take_output()
        lines = [Printed(line.text, line.stream) for line in printed.lines]
        if printed.dropped:
            lines.append(Printed(f"({printed.dropped} bytes more were printed and are left out)", "err"))
        return lines

    @property
    def wake_ns(self) -> int | None:
        return self._guest.wake_ns

    def exchange(self) -> bool:
        return self._has_joined and self._guest.exchange()

    def close(self) -> None:
        self._guest.close()

    def _join(self) -> None:
        self._guest.join()
        self._has_joined = True


class OwnNode:
    """A node of the kit's own in place of a program. It runs until it is ended."""

    is_ours = True

    def __init__(self, *nodes: Node) -> None:
        self._nodes = nodes
        self.pid = os.getpid()

    def poll(self) -> Ended | None:
        return None

    def take_lines(self) -> list[Printed]:
        return []

    def wait_until_started(self) -> None:
        """It is there at once."""

    @property
    def wake_ns(self) -> int | None:
        return None

    def exchange(self) -> bool:
        return False

    def close(self) -> None:
        for node in self._nodes:
            node.destroy_node()


class CommandProcess:
    """Any other program, as the user's shell would start it."""

    is_ours = False

    def __init__(
        self, command: Sequence[str], *, shell: bool, environment: Mapping[str, str], cwd: Path
    ) -> None:
        self._process = subprocess.Popen(
            " ".join(command) if shell else list(command),
            shell=shell,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            cwd=cwd,
            env=dict(environment),
            start_new_session=True,
            bufsize=0,
        )
        self.pid = self._process.pid
        assert self._process.stdout is not None
        assert self._process.stderr is not None
        self._streams = {"out": self._process.stdout, "err": self._process.stderr}
        self._begun = {"out": b"", "err": b""}
        for stream in self._streams.values():
            os.set_blocking(stream.fileno(), False)

    def poll(self) -> Ended | None:
        code = self._process.poll()
        return None if code is None else Ended(code if code >= 0 else 128 - code)

    def take_lines(self) -> list[Printed]:
        lines: list[Printed] = []
        for name, stream in self._streams.items():
            if stream.closed:
                continue
            data = b""
            with suppress(BlockingIOError):
                while part := os.read(stream.fileno(), 1 << 16):
                    data += part
            *whole, rest = (self._begun[name] + data).split(b"\n")
            self._begun[name] = rest[:LONGEST_LINE]
            lines += [_line(line, name) for line in whole]
            if rest and self._process.poll() is not None:
                self._begun[name] = b""
                lines.append(_line(rest, name))
        return lines

    def wait_until_started(self) -> None:
        """It is there at once."""

    @property
    def wake_ns(self) -> int | None:
        return None

    def exchange(self) -> bool:
        return False

    def close(self) -> None:
        for number in (signal.SIGINT, signal.SIGKILL):
            with suppress(ProcessLookupError, PermissionError):
                os.killpg(self.pid, number)
            with suppress(subprocess.TimeoutExpired):
                self._process.wait(FAREWELL_S)
                break
        for stream in self._streams.values():
            stream.close()


def _line(data: bytes, name: str) -> Printed:
    text = printable(data[:LONGEST_LINE].decode("utf-8", "replace").rstrip("\r"))
    return Printed(text, "out" if name == "out" else "err")


def kit_command(arguments: Sequence[str]) -> list[str]:
    """The kit's own command line, whatever it is called where it is installed."""
    return [sys.executable, "-m", "kit", *arguments]
