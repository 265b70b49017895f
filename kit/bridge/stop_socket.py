"""Stops running bridges from another terminal: a socket for each, beside those of the running worlds."""

from __future__ import annotations

import socket
import threading
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import Final, Self

from kit.bridge.bridge import JOIN_S, Bridge
from kit.inspection.world_sockets import connect, listen, running_worlds, sockets_folder

STOP: Final = b"stop\n"
ANSWER_TIMEOUT_S: Final = 5.0
MAX_ANSWER: Final = 1 << 16


def bridges_folder(workspace: Path) -> Path:
    """This machine's folder of the bridges' sockets in a workspace."""
    return sockets_folder(workspace) / "bridges"


class StopSocket:
    """Stops ``bridge`` when ``stop_bridges`` asks, in a thread of its own, whatever the bridge's world does meanwhile.

    Opening raises OSError where the folder cannot hold a socket. Use it as a context manager.
    """

    def __init__(self, bridge: Bridge, workspace: Path, name: str, on_stop: Callable[[str], object]) -> None:
        self._bridge = bridge
        self._on_stop = on_stop
        self._is_closed = False
        self._listener, self.path = listen(bridges_folder(workspace), name)
        self._thread = threading.Thread(target=self._serve, name="bridge-stop", daemon=True)

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, problem: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._is_closed = True
        with suppress(OSError):
            connect(self.path).close()  # wakes the thread
        self._thread.join(JOIN_S)  # it may be in a stop that a wire does not take
        self._listener.close()
        with suppress(FileNotFoundError):
            self.path.unlink()

    def _serve(self) -> None:
        while True:
            connection, _ = self._listener.accept()
            with connection, suppress(OSError):  # the other end has gone
                if self._is_closed:
                    return
                connection.settimeout(ANSWER_TIMEOUT_S)
                if connection.recv(len(STOP)) == STOP:
                    topics = self._bridge.stop()
                    self._on_stop("stopped by `kit bridge stop`")
                    connection.sendall((", ".join(topics) or "no topic that moves a robot").encode())


def stop_bridges(workspace: Path) -> list[tuple[str, str]]:
    """Stops every running bridge of a workspace; returns the names, and which topics were told to stand, or why not."""
    answers = []
    for found in running_worlds(bridges_folder(workspace)):
        try:
            with connect(found.path) as connection:
                connection.settimeout(ANSWER_TIMEOUT_S)
                connection.sendall(STOP)
                connection.shutdown(socket.SHUT_WR)
                answer = connection.recv(MAX_ANSWER).decode() or "it has just ended, and stopped its robots"
        except OSError as problem:
            answer = f"it does not answer ({problem}): end its process, or stop the robot by its own switch"
        answers.append((found.name, answer))
    return answers
