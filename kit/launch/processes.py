"""The processes of a launch (node programs, other commands, the kit's own programs), and why one could not start."""

from __future__ import annotations

import os
import signal
import subprocess
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Final, Literal, NamedTuple, Protocol

from kit.host.failure import Failure, StudentCodeError
from kit.host.node_process import NodeProcess
from kit.host.wire import printable
from kit.ros.node.node import Node


class ProcessStartError(Exception):
    """A process cannot be started; the message says what is missing, and which line asked for it."""


class ProgramUnavailable(ProcessStartError):
    """A program of a kind that the kit does not run: a launch goes on without it."""


EXIT_TIMEOUT_S: Final = 2.0
"""How long a command may take to end after SIGINT [s]."""

MAX_LINE_LENGTH: Final = 4000
"""Bytes of a printed line that are kept."""

MAX_READ: Final = 1 << 20
"""Bytes of a command's output that are read at once, or a little more: one that prints without end waits meanwhile."""


class PrintedLine(NamedTuple):
    """A line that a process has printed."""

    text: str
    stream: Literal["out", "err"]


class ProcessExit(NamedTuple):
    """How a process has ended: its exit code, and the failure as text if there is one."""

    code: int
    reason: str = ""


class Process(Protocol):
    """A process of a launch. ``poll`` is called between ticks and never waits."""

    pid: int
    is_builtin: bool
    """Whether the kit brings it itself; such a process never ends by itself."""

    def poll(self) -> ProcessExit | None:
        """The exit status; None while it runs."""

    def take_lines(self) -> list[PrintedLine]:
        """Removes and returns the lines it has printed."""

    def wait_until_started(self) -> None:
        """Waits until its nodes are in the graph, or it has failed."""

    def request_tick(self) -> None:
        """Requests, from any thread, that the next ``exchange`` takes place though nothing is due."""

    @property
    def wake_ns(self) -> int | None:
        """When its next timer is due [ns of the graph]; None: it waits for messages only."""

    @property
    def node_names(self) -> frozenset[str]:
        """The full names of the nodes that it runs in lock-step."""

    def exchange(self) -> bool:
        """Exchanges messages, as a participant of the lock-step."""

    def close(self) -> None:
        """Ends it. May be called twice."""


class NodeProgramProcess:
    """A program with nodes, which join the graph as soon as it has started."""

    is_builtin = False

    def __init__(
        self,
        node_process: NodeProcess,
        on_loaded: Callable[[], object] | None = None,
        *,
        is_interruptible: bool = False,
    ) -> None:
        """``on_loaded``: called before a program that ``loads_first`` goes on into the graph. ``is_interruptible``: whether it
        is told of its end, and may do then what it does at Ctrl-C."""
        self._is_interruptible = is_interruptible
        self._node_process = node_process
        self._on_loaded = on_loaded
        self._has_joined = self._is_closed = False
        self._failure: Failure | None = None
        self.pid = node_process.pid

    def poll(self) -> ProcessExit | None:
        if not (self._has_joined or self._is_closed) and self._failure is None:
            try:
                if self._node_process.is_started():
                    self._join()
            except StudentCodeError as error:
                self._failure = error.failure
        failure = self._failure or self._node_process.failure
        if failure is not None:
            return ProcessExit(failure.status, str(failure))
        return ProcessExit(self._node_process.exit_code) if self._node_process.has_ended else None

    def wait_until_started(self) -> None:
        if not self._has_joined and self._failure is None:
            try:
                self._node_process.wait_until_started()
                if self._on_loaded is not None:
                    self._on_loaded()
                    self._node_process.enter_graph()
                self._join()
            except StudentCodeError as error:
                self._failure = error.failure

    def request_tick(self) -> None:
        self._node_process.request_tick()

    def take_lines(self) -> list[PrintedLine]:
        printed = self._node_process.take_output()
        lines = [PrintedLine(line.text, line.stream) for line in printed.lines]
        if printed.omission:
            lines.append(PrintedLine(printed.omission, "err"))
        return lines

    @property
    def wake_ns(self) -> int | None:
        return self._node_process.wake_ns

    @property
    def node_names(self) -> frozenset[str]:
        return self._node_process.node_names

    def exchange(self) -> bool:
        return self._has_joined and self._node_process.exchange()

    def close(self) -> None:
        self._is_closed = True
        try:
            if self._is_interruptible:
                self._node_process.interrupt()
        finally:  # Ctrl-C once more
            self._node_process.close()

    def _join(self) -> None:
        self._node_process.join()
        self._has_joined = True


class _UnsteppedProcess:
    """What a process does in place of the lock-step that it does not take part in: nothing."""

    def wait_until_started(self) -> None:
        """No-op: it has started already."""

    def request_tick(self) -> None:
        """No-op: it does not run in lock-step."""

    @property
    def wake_ns(self) -> int | None:
        return None

    @property
    def node_names(self) -> frozenset[str]:
        return frozenset()

    def exchange(self) -> bool:
        return False


class BuiltinProcess(_UnsteppedProcess):
    """Nodes of the kit itself in place of a program. They run until they are ended."""

    is_builtin = True

    def __init__(self, *nodes: Node) -> None:
        self._nodes = nodes
        self.pid = os.getpid()

    def poll(self) -> ProcessExit | None:
        return None

    def take_lines(self) -> list[PrintedLine]:
        return []

    def close(self) -> None:
        for node in self._nodes:
            node.destroy_node()


class CommandProcess(_UnsteppedProcess):
    """Any other program, started as by the user's shell."""

    is_builtin = False

    def __init__(
        self,
        command: Sequence[str],
        *,
        shell: bool,
        environment: Mapping[str, str],
        cwd: Path,
        is_of_kit: bool = False,
    ) -> None:
        """``is_of_kit``: it is, or calls, a command of the kit's, which connects to the world."""
        self.is_of_kit = is_of_kit
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
        self._partial_lines = {"out": b"", "err": b""}
        self._last_lines: list[PrintedLine] = []
        for stream in self._streams.values():
            os.set_blocking(stream.fileno(), False)

    def poll(self) -> ProcessExit | None:
        code = self._process.poll()
        return None if code is None else ProcessExit(code if code >= 0 else 128 - code)

    def take_lines(self) -> list[PrintedLine]:
        lines, self._last_lines = self._last_lines, []
        for name, stream in self._streams.items():
            if stream.closed:
                continue
            data = b""
            with suppress(BlockingIOError):
                while len(data) < MAX_READ and (part := os.read(stream.fileno(), 1 << 16)):
                    data += part
            *whole, rest = (self._partial_lines[name] + data).split(b"\n")
            self._partial_lines[name] = rest[: MAX_LINE_LENGTH + 1]
            lines += [_line(line, name) for line in whole]
            if rest and self._process.poll() is not None:
                self._partial_lines[name] = b""
                lines.append(_line(rest, name))
        return lines

    def close(self) -> None:
        for number in (signal.SIGINT, signal.SIGKILL):
            with suppress(ProcessLookupError, PermissionError):
                os.killpg(self.pid, number)
            with suppress(subprocess.TimeoutExpired):
                self._process.wait(EXIT_TIMEOUT_S)
                break
        self._last_lines = self.take_lines()  # what it has said because of its end
        for stream in self._streams.values():
            stream.close()


def _line(data: bytes, name: str) -> PrintedLine:
    text = printable(data[:MAX_LINE_LENGTH].decode("utf-8", "replace").rstrip("\r"))
    if len(data) > MAX_LINE_LENGTH:
        text += f"... (cut after {MAX_LINE_LENGTH} bytes)"
    return PrintedLine(text, "out" if name == "out" else "err")
