"""The world's door: a socket in the workspace through which other terminals come in."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from queue import SimpleQueue
from types import TracebackType
from typing import Final, Self

from kit.host.wire import ProtocolError
from kit.inspection.client_connection import Visitor
from kit.inspection.framed_socket import Line
from kit.inspection.world_sockets import connect, listen
from kit.ros.graph.graph import Graph

MOST_VISITORS: Final = 32
NAME: Final = "door"


def open_door(
    graph: Graph, folder: Path, world: str, wake: Callable[[], object] = lambda: None
) -> Door | None:
    """A door, or a line in the graph's log that says why there can be none: a world runs without one too."""
    try:
        return Door(graph, folder, world, wake=wake)
    except OSError as problem:
        graph.log.warning(NAME, f"other terminals cannot look in: {folder}: {problem.strerror or problem}")
        return None


class Door:
    """Lets visitors into a graph. A guest of whoever ticks: its ``exchange`` is called in each tick.

    ``wake`` is called, in other threads, when a visitor has said something: for a world that stands still. Opening
    raises OSError when the folder cannot hold a socket. Close it, or use it as a context manager.
    """

    def __init__(
        self, graph: Graph, folder: Path, world: str, *, wake: Callable[[], object] = lambda: None
    ) -> None:
        self._graph = graph
        self._wake = wake
        self._world = world
        self._coming: SimpleQueue[Line] = SimpleQueue()
        self._visitors: list[Visitor] = []
        self._is_closed = False
        self._listener, self.path = listen(folder, world)
        threading.Thread(target=self._receive, name="door", daemon=True).start()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, problem: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    @property
    def visitors(self) -> int:
        """How many are in."""
        return len(self._visitors)

    def exchange(self) -> bool:
        """Lets in who has come, and talks with everybody without waiting; whether anything was said."""
        if not self._visitors and self._coming.empty():
            return False
        while not self._coming.empty():
            self._let_in(self._coming.get())
        said = False
        for visitor in self._visitors:
            try:
                said |= visitor.exchange()
            except ProtocolError as problem:
                self._graph.log.warning(NAME, f"a visitor was shown out, who said {problem}")
                visitor.close()
        self._visitors = [visitor for visitor in self._visitors if not visitor.is_gone]
        return said

    def close(self) -> None:
        """Shows everybody out; the socket is gone. May be called twice."""
        if self._is_closed:
            return
        self._is_closed = True
        with suppress(OSError):
            connect(self.path).close()  # wakes the thread that waits for visitors
        with suppress(FileNotFoundError):
            self.path.unlink()
        for visitor in self._visitors:
            visitor.close()
        self._visitors = []
        self._turn_away()

    def _turn_away(self) -> None:
        """Who has knocked and was not let in."""
        while not self._coming.empty():
            self._coming.get().close()

    def _let_in(self, line: Line) -> None:
        if len(self._visitors) >= MOST_VISITORS:
            self._graph.log.warning(NAME, f"{MOST_VISITORS} visitors are in; one more has to wait outside")
            line.close()
            return
        self._visitors.append(Visitor(line, self._graph, self._world, self._wake))

    def _receive(self) -> None:
        """In the door's own thread: waits for visitors."""
        while True:
            try:
                connection, _ = self._listener.accept()
            except OSError:
                break
            line = Line(connection)
            if self._is_closed:
                line.close()
                break
            if line.peer_user not in (None, 0, os.getuid()):  # the folder's mode forbids it already
                line.close()
                continue
            self._coming.put(line)
            self._wake()
        self._listener.close()
        self._turn_away()
