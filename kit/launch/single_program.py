"""Runs one program: in the graph of a world that runs in another terminal, or alone."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial
from pathlib import Path

from kit.host.program_terminal import ProgramTerminal, piped_streams
from kit.inspection.client import InspectionClient
from kit.inspection.server import InspectionServer
from kit.launch.launch_run import GraphOnlyRun
from kit.launch.processes import PrintedLine, Process, ProcessExit, ProcessStartError
from kit.launch.program_lookup import StartContext, is_builtin, start_process
from kit.launch.requests import StartRequest
from kit.ros.graph.graph import Graph
from kit.run.connection_watch import LOOK_INTERVAL_NS, ConnectionWatch
from kit.run.episode import run_until, when
from kit.run.pacing import Schedule

OutputCallback = Callable[[PrintedLine], None]


class SingleProgram:
    """A program of a package, or a Python file."""

    def __init__(
        self,
        request: StartRequest,
        search: tuple[Path, ...],
        *,
        seed: int,
        workspace: Path,
        terminal: ProgramTerminal | None = None,
    ) -> None:
        """``terminal``: what the program reads and writes; without one, what is piped into this process is its input."""
        self._terminal = terminal
        self._request, self._search, self._seed, self._workspace = request, search, seed, workspace

    def run_beside(self, client: InspectionClient, on_output: OutputCallback) -> ProcessExit:
        """Runs it until it ends, in the graph and time of another terminal's world. Raises ProcessStartError, WorldDisconnected."""
        process, graph = self._started(client.graph, client.hold_time), client.graph
        watch = _watch_connections(graph, process, on_output)
        try:
            while (ended := self._poll(process, on_output)) is None:
                seen = graph.change_count
                while process.exchange():
                    self._print(process, on_output)
                watch.look()
                if process.poll() is None:
                    look_ns = graph.now_ns + LOOK_INTERVAL_NS
                    wake_ns = look_ns if process.wake_ns is None else min(process.wake_ns, look_ns)
                    graph.wait(partial(_has_changed, graph, seen), wake_ns)
            return ended
        finally:
            self._end(process, on_output)

    def run_alone(self, sockets: Path, on_output: OutputCallback) -> ProcessExit:
        """Runs it until it ends, in real time, with a socket for other terminals. Raises ProcessStartError, OSError."""
        graph_only_run = GraphOnlyRun(Graph())
        with InspectionServer(graph_only_run.graph, sockets, self._request.title) as server:
            process = self._started(graph_only_run.graph)
            graph_only_run.participants += [process, server]
            ended: ProcessExit | None = None
            watch = _watch_connections(graph_only_run.graph, process, on_output)

            def has_ended() -> bool:
                nonlocal ended
                watch.look()
                ended = self._poll(process, on_output)
                return ended is not None

            try:
                run_until(
                    graph_only_run, ends=(when(has_ended),), schedule=Schedule(graph_only_run.step_size)
                )
                assert ended is not None  # nothing else ends this
                return ended
            finally:
                self._end(process, on_output)

    def _started(self, graph: Graph, on_loaded: Callable[[], object] | None = None) -> Process:
        if is_builtin(self._request) and self._request.package != "tf2_ros":
            raise ProcessStartError(
                f"{self._request.executable} cannot be started by itself here: `kit drive` and `kit launch` start "
                "the world and its view"
            )
        context = StartContext(
            graph,
            self._search,
            self._seed,
            _ignore,
            _ignore,
            _ignore_view_request,
            self._workspace,
            "",
            streams=piped_streams() if self._terminal is None else self._terminal.streams,
            on_loaded=on_loaded,
        )
        process = start_process(self._request, context)
        if self._terminal is not None:
            # A program that waits for the next tick is told of Ctrl-C by that tick.
            self._terminal.on_interrupt = process.request_tick
        process.wait_until_started()
        return process

    def _poll(self, process: Process, on_output: OutputCallback) -> ProcessExit | None:
        ended = process.poll()
        self._print(process, on_output)
        return ended

    def _end(self, process: Process, on_output: OutputCallback) -> None:
        self._print(process, on_output)
        process.close()
        self._print(process, on_output)  # what it has said because of its end

    def _print(self, process: Process, on_output: OutputCallback) -> None:
        lines: Iterable[PrintedLine] = process.take_lines()
        for line in lines:
            on_output(line)


def _watch_connections(graph: Graph, process: Process, on_output: OutputCallback) -> ConnectionWatch:
    return ConnectionWatch(
        graph,
        lambda: process.node_names,
        lambda text: on_output(PrintedLine(f"[WARN] [kit]: {text}", "err")),
    )


def _has_changed(graph: Graph, since: int) -> bool:
    return graph.change_count != since


def _ignore(_: object) -> None:
    """No-op callback."""


def _ignore_view_request() -> None:
    """No-op: there is no view."""
