"""One program by itself: beside a world that runs in another terminal, or alone."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial
from pathlib import Path

from kit.inspection.client import InspectionClient
from kit.inspection.server import InspectionServer
from kit.launch.errors import CannotStart
from kit.launch.graph_only import Worldless
from kit.launch.processes import Ended, Printed, Process
from kit.launch.program_lookup import Means, is_ours, start
from kit.launch.requests import Start
from kit.ros.graph.graph import Graph
from kit.run.episode import run_until, when
from kit.run.pacing import Schedule

Say = Callable[[Printed], None]


class Single:
    """A program of a package, or a Python file, to be started in some graph."""

    def __init__(self, request: Start, search: tuple[Path, ...], *, seed: int, workspace: Path) -> None:
        self._request, self._search, self._seed, self._workspace = request, search, seed, workspace

    def run_beside(self, client: InspectionClient, say: Say) -> Ended:
        """Until it ends, in the time of the world visited. Raises CannotStart, WorldDisconnected."""
        process, graph = self._started(client.graph), client.graph
        try:
            while (ended := self._look(process, say)) is None:
                seen = graph.change_count
                while process.exchange():
                    self._print(process, say)
                if process.poll() is None:
                    graph.wait(partial(_has_changed, graph, seen), process.wake_ns)
            return ended
        finally:
            self._print(process, say)
            process.close()

    def run_alone(self, sockets: Path, say: Say) -> Ended:
        """Until it ends, in real time, with a socket for other terminals. Raises CannotStart, OSError."""
        worldless = Worldless(Graph())
        with InspectionServer(worldless.graph, sockets, self._request.title) as server:
            process = self._started(worldless.graph)
            worldless.participants += [process, server]
            ended: Ended | None = None

            def has_ended() -> bool:
                nonlocal ended
                ended = self._look(process, say)
                return ended is not None

            try:
                run_until(worldless, ends=(when(has_ended),), schedule=Schedule(worldless.step_size))
                assert ended is not None  # nothing else ends this
                return ended
            finally:
                self._print(process, say)
                process.close()

    def _started(self, graph: Graph) -> Process:
        if is_ours(self._request) and self._request.package != "tf2_ros":
            raise CannotStart(
                f"{self._request.executable} is not started by itself here: `kit play` and `kit launch` bring "
                "the world and its view"
            )
        means = Means(graph, self._search, self._seed, _nothing, _nothing, _none, self._workspace, "")
        process = start(self._request, means)
        process.wait_until_started()
        return process

    def _look(self, process: Process, say: Say) -> Ended | None:
        ended = process.poll()
        self._print(process, say)
        return ended

    def _print(self, process: Process, say: Say) -> None:
        lines: Iterable[Printed] = process.take_lines()
        for line in lines:
            say(line)


def _has_changed(graph: Graph, since: int) -> bool:
    return graph.change_count != since


def _nothing(_: object) -> None:
    """Nobody is told."""


def _none() -> None:
    """There is no view to be wanted."""
