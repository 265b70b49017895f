"""The inspection server: a socket in the workspace to which other terminals of the user connect."""

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
from kit.inspection.client_connection import ClientConnection
from kit.inspection.framed_socket import FramedSocket
from kit.inspection.world_sockets import connect, listen
from kit.ros.graph.graph import Graph

MAX_CLIENTS: Final = 32
LOGGER_NAME: Final = "inspection"


def open_inspection_server(
    graph: Graph, folder: Path, world: str, wake: Callable[[], object] = lambda: None
) -> InspectionServer | None:
    """Opens a server; if that fails, logs why and returns None: the world runs without one too."""
    try:
        return InspectionServer(graph, folder, world, wake=wake)
    except OSError as problem:
        graph.log.warning(
            LOGGER_NAME,
            f"other terminals cannot connect to this world: {folder}: {problem.strerror or problem}",
        )
        return None


class InspectionServer:
    """Accepts clients of a graph. A participant of the lock-step: ``exchange`` is called in each tick.

    ``wake`` is called, in other threads, when a client has sent something: a paused world needs it. Opening raises
    OSError if the folder cannot hold a socket. Close it, or use it as a context manager.
    """

    def __init__(
        self, graph: Graph, folder: Path, world: str, *, wake: Callable[[], object] = lambda: None
    ) -> None:
        self._graph = graph
        self._wake = wake
        self._world = world
        self._accepted: SimpleQueue[FramedSocket] = SimpleQueue()
        self._clients: list[ClientConnection] = []
        self._is_closed = False
        self._listener, self.path = listen(folder, world)
        threading.Thread(target=self._receive, name="inspection-server", daemon=True).start()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, problem: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    @property
    def client_count(self) -> int:
        """The number of connected clients."""
        return len(self._clients)

    def exchange(self) -> bool:
        """Adds new clients and exchanges messages with all of them, without waiting. True if any client sent
        something."""
        if not self._clients and self._accepted.empty():
            return False
        while not self._accepted.empty():
            self._add_client(self._accepted.get())
        has_sent = False
        for client in self._clients:
            try:
                has_sent |= client.exchange()
            except ProtocolError as problem:
                self._graph.log.warning(LOGGER_NAME, f"a terminal was disconnected because it sent {problem}")
                client.refuse(str(problem))
        self._clients = [client for client in self._clients if not client.is_closed]
        return has_sent

    def close(self) -> None:
        """Disconnects all clients and removes the socket. May be called twice."""
        if self._is_closed:
            return
        self._is_closed = True
        with suppress(OSError):
            connect(self.path).close()  # wakes the thread that accepts connections
        with suppress(FileNotFoundError):
            self.path.unlink()
        for client in self._clients:
            client.close()
        self._clients = []
        self._close_accepted()

    def _close_accepted(self) -> None:
        """Closes the connections that were accepted and not yet added."""
        while not self._accepted.empty():
            self._accepted.get().close()

    def _add_client(self, connection: FramedSocket) -> None:
        if len(self._clients) >= MAX_CLIENTS:
            self._graph.log.warning(
                LOGGER_NAME, f"{MAX_CLIENTS} terminals are connected already; one more was refused"
            )
            connection.close()
            return
        self._clients.append(ClientConnection(connection, self._graph, self._world, self._wake))

    def _receive(self) -> None:
        """Accepts connections, in the server's own thread."""
        while True:
            try:
                accepted, _ = self._listener.accept()
            except OSError:
                break
            connection = FramedSocket(accepted)
            if self._is_closed:
                connection.close()
                break
            if connection.peer_user not in (None, 0, os.getuid()):  # the folder's mode forbids it already
                connection.close()
                continue
            self._accepted.put(connection)
            self._wake()
        self._listener.close()
        self._close_accepted()
