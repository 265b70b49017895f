"""What a launch test records of its processes, what they print and how they end, and the tests' waits for either.

A wait is one of the graph: its time-out is simulated, and who waits is known to wait.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from kit.ros.execution.context import get_default_context
from kit.ros.graph.graph import Graph
from kit.ros.launch.events import ProcessExited, ProcessIO, ProcessStarted, RunningProcessEvent
from kit.ros.launch.processes import ExecuteProcess
from kit.ros.launch.testing.asserts import assert_in_stream
from kit.ros.launch.testing.lookup import NoMatchingProcessException, process_name, resolve_processes
from kit.ros.node.time import S_TO_NS


class IoHandler:
    """What the processes have printed, in the order in which it came: ``proc_output`` of tests after the shutdown."""

    def __init__(self) -> None:
        self._printed: list[ProcessIO] = []

    def append(self, process_io: ProcessIO) -> None:
        self._printed.append(process_io)

    def __iter__(self) -> Iterator[ProcessIO]:
        return iter(list(self._printed))

    def processes(self) -> list[ExecuteProcess]:
        """The actions of the processes that have printed something."""
        return list(dict.fromkeys(each.action for each in self._printed))

    def process_names(self) -> list[str]:
        return list(dict.fromkeys(each.process_name for each in self._printed))

    def __getitem__(self, key: ExecuteProcess | str) -> list[ProcessIO]:
        """What one process has printed, by its action or its whole name. Raises KeyError if that is nothing."""
        name = key if isinstance(key, str) else process_name(key)
        found = [each for each in self._printed if each.process_name == name]
        if not found:
            raise KeyError(key)
        return found


class ActiveIoHandler(IoHandler):
    """Likewise while the processes run: tests can wait for what is printed."""

    def __init__(self, graph: Graph | None = None) -> None:
        super().__init__()
        self._graph = graph or get_default_context().graph

    def append(self, process_io: ProcessIO) -> None:
        super().append(process_io)
        self._graph.notify()

    def at_rest(self) -> IoHandler:
        """The same records, for tests that cannot wait any more."""
        rest = IoHandler()
        rest._printed = self._printed
        return rest

    def waitFor(  # noqa: N802 - launch_testing's names, here and below
        self,
        expected_output: Any,
        process: ExecuteProcess | str | None = None,
        cmd_args: Any = None,
        *,
        strict_proc_matching: bool = True,
        output_filter: Callable[[str], str] | None = None,
        timeout: float = 10,
        strip_ansi_escape_sequences: bool = True,
        stream: str = "stderr",
    ) -> bool:
        """Waits until a process has printed this; False after ``timeout`` [s]. Raises Exception if it has printed nothing at all."""

        def is_printed() -> bool:
            try:
                assert_in_stream(
                    self,
                    expected_output,
                    process,
                    cmd_args,
                    output_filter=output_filter,
                    strict_proc_matching=strict_proc_matching,
                    strip_ansi_escape_sequences=strip_ansi_escape_sequences,
                    stream=stream,
                )
            except (AssertionError, NoMatchingProcessException):
                return False
            return True

        if _wait(self._graph, is_printed, timeout):
            return True
        resolve_processes(self, process=process, cmd_args=cmd_args, strict_proc_matching=False)
        return False

    def assertWaitFor(self, *args: Any, **kwargs: Any) -> None:  # noqa: N802
        """As ``waitFor``, but raises AssertionError after the time-out."""
        if not self.waitFor(*args, **kwargs):
            stream = kwargs.get("stream", "stderr")
            expected = args[0] if args else kwargs.get("expected_output")
            raise AssertionError(
                f"Waiting for output timed out: {expected!r} is not on {stream}{self._on_other_stream(expected, stream)}"
            )

    def _on_other_stream(self, expected: Any, stream: str) -> str:
        """Where else the text is, as the end of a message."""
        other = "stdout" if stream == "stderr" else "stderr"
        printed = "".join(
            each.text.decode() for each in self._printed if each.from_stdout == (other == "stdout")
        )
        if isinstance(expected, str) and expected in printed:
            return f", but on {other}: say stream={other!r}"
        return ""


class ProcInfoHandler:
    """How the processes have ended: ``proc_info`` of tests after the shutdown."""

    def __init__(self) -> None:
        self._ended: dict[ExecuteProcess, RunningProcessEvent] = {}

    def append(self, process_info: RunningProcessEvent) -> None:
        self._ended[process_info.action] = process_info

    def __iter__(self) -> Iterator[RunningProcessEvent]:
        return iter(list(self._ended.values()))

    def processes(self) -> list[ExecuteProcess]:
        return list(self._ended)

    def process_names(self) -> list[str]:
        return [process_name(each) for each in self._ended]

    def __getitem__(self, key: ExecuteProcess | str) -> RunningProcessEvent:
        """The last event of a process, by its action or a part of its name. Raises KeyError."""
        if not isinstance(key, str):
            return self._ended[key]
        for action, event in self._ended.items():
            if key in process_name(action):
                return event
        raise KeyError(key)


class ActiveProcInfoHandler(ProcInfoHandler):
    """Likewise while the processes run: tests can wait for their starts and ends."""

    def __init__(self, graph: Graph | None = None) -> None:
        super().__init__()
        self._graph = graph or get_default_context().graph

    def append(self, process_info: RunningProcessEvent) -> None:
        super().append(process_info)
        self._graph.notify()

    def at_rest(self) -> ProcInfoHandler:
        """The same records, for tests that cannot wait any more."""
        rest = ProcInfoHandler()
        rest._ended = self._ended
        return rest

    def assertWaitForShutdown(  # noqa: N802
        self, process: ExecuteProcess | str, cmd_args: Any = None, *, timeout: float = 10
    ) -> None:
        """Waits until the process has ended. Raises AssertionError after ``timeout`` [s]."""
        self._wait_for(process, cmd_args, timeout, (ProcessExited,), "finish")

    def assertWaitForStartup(  # noqa: N802
        self, process: ExecuteProcess | str, cmd_args: Any = None, *, timeout: float = 10
    ) -> None:
        """Waits until the process has been started. Raises AssertionError after ``timeout`` [s]."""
        self._wait_for(process, cmd_args, timeout, (ProcessStarted, ProcessExited), "start")

    def _wait_for(
        self,
        process: ExecuteProcess | str,
        cmd_args: Any,
        timeout: float,
        events: tuple[type[RunningProcessEvent], ...],
        what: str,
    ) -> None:
        def has_happened() -> bool:
            try:
                found = resolve_processes(self, process=process, cmd_args=cmd_args)
            except NoMatchingProcessException:
                return False
            return isinstance(self._ended[found[0]], events)

        if not _wait(self._graph, has_happened, timeout):
            name = process if isinstance(process, str) else process_name(process)
            raise AssertionError(f"Timed out waiting for process '{name}' to {what}")


def _wait(graph: Graph, ready: Callable[[], bool], timeout_s: float) -> bool:
    """Waits in the graph until ``ready()``; False after ``timeout_s``."""
    until = graph.now_ns + round(timeout_s * S_TO_NS)
    return graph.wait(ready, until, what="a launch test") or ready()
