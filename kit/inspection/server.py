"""The inspection server: a socket in the workspace to which other terminals of the user connect.

Each connection sends its client the graph's changes and messages. The world waits for a client only where it asks for that
(``HOLD_NS``): a program from another terminal enters the graph at one instant, on any machine, under any load.
"""

from __future__ import annotations

import os
import threading
import time
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from queue import Empty, SimpleQueue
from typing import Final, Self

import kit
from kit.host.graph_bridge import ParentBridge
from kit.host.protocol import HOLD_NS, Ended, Reply, parse
from kit.host.wire import Json, ProtocolError
from kit.inspection.sockets import FramedSocket, connect, listen
from kit.ros.graph.graph import Graph

MAX_BACKLOG: Final = 20_000
"""Messages that may wait for a client. One that is farther behind no longer reads and is disconnected."""


MAX_LATE_NS: Final = 10_000_000_000
"""How late a client may be and still be woken at the time at which it was to be [ns]: one that was stopped for longer begins
anew at the present."""
MAX_FALLING_BEHIND: Final = 10
"""How many times in succession it may be later than the time before: one that takes longer than its timers allow, on any
machine, goes on at the present."""
HOLD_S: Final = 10.0
"""How long the world stands still for a client at most, by the wall clock [s]."""
LOOK_S: Final = 0.05
"""After this long it looks whether it has ended meanwhile [s]."""


class ClientConnection:
    """One connected terminal. ``exchange`` is called in the world's thread.

    Its own thread does nothing but wait: for the client's answer, then for the world's next question. So a
    client costs the world no more than what it asks for, however slow it is.
    """

    def __init__(
        self, connection: FramedSocket, graph: Graph, world: str, wake: Callable[[], object]
    ) -> None:
        self._connection = connection
        self.pid = connection.peer_process
        """Process id of the client; None where it cannot be known."""
        self._graph = graph
        self._wake = wake
        self._bridge = ParentBridge(graph, shares_interfaces=True)
        self._questions: SimpleQueue[list[Json] | None] = SimpleQueue()
        self._answers: SimpleQueue[Reply | Ended | Exception] = SimpleQueue()
        self._seq = 0
        self._sent_ns = graph.now_ns
        self._wake_ns: int | None = None
        self._ticks: deque[int] = deque()
        """The times of the world's ticks since the last question [ns], and that of the present one."""
        self._late_ns = 0
        """How late it was when it was last woken [ns]."""
        self._falling_behind = 0
        """How many times in succession it was later than before."""
        self._is_waiting = False
        self._is_asked = True
        """Whether an answer is still to come."""
        self._holds = False
        """Whether the world is to stand still while the next question is answered."""
        self.is_closed = False
        start = {
            "version": kit.__version__,
            "world": world,
            "now": self._sent_ns,
            "events": self._bridge.take_changes(),
        }
        self._questions.put(["start", 0, start])
        threading.Thread(target=self._serve, name="inspection-client", daemon=True).start()

    @property
    def owes_answer(self) -> bool:
        """Whether it has been sent something that it has not answered yet, or is about to be."""
        return self._is_asked or self._bridge.has_pending

    @property
    def is_waited_for(self) -> bool:
        """Whether time stands still until it has answered."""
        return self._holds and self._is_asked

    def wait_for_answer(self) -> bool:
        """Waits for the answer for which time stands still, and applies it; True if the client sent something.

        At most ``HOLD_S``: from then on it is like any other client. Raises ProtocolError.
        """
        end = time.monotonic() + HOLD_S
        while not self.is_closed and time.monotonic() < end:
            with suppress(Empty):
                return self._apply_answer(self._answers.get(timeout=LOOK_S))
        self._holds = False
        return False

    def exchange(self) -> bool:
        """Applies the client's answer if one has come, and sends what is new. True if the client sent something.

        Raises ProtocolError for an answer that makes no sense.
        """
        has_sent = not self._answers.empty() and self._apply_answer(self._answers.get())
        now = self._graph.now_ns
        if not self._ticks or self._ticks[-1] != now:
            if self._ticks and now < self._ticks[-1]:
                self._ticks.clear()
            self._ticks.append(now)
            while self._ticks[0] <= self._sent_ns < now or now - self._ticks[0] > MAX_LATE_NS:
                self._ticks.popleft()
        has_woken = (
            self._wake_ns is not None
            and self._wake_ns <= now
            and (now != self._sent_ns or self._wake_ns == HOLD_NS)
        )
        if self._is_waiting and (self._bridge.has_pending or has_woken or now < self._sent_ns):
            self._send_news()
        if len(self._bridge.pending) > MAX_BACKLOG:
            raise ProtocolError(f"nothing any more: it is {MAX_BACKLOG} messages behind")
        return has_sent

    def refuse(self, reason: str) -> None:
        """Disconnects the client, which is told why if it still listens, and removes its nodes from the graph."""
        if self._is_asked:  # its thread waits for an answer that may never come
            self.close()
            return
        self.is_closed = True
        self._bridge.clear()
        self._questions.put(["refused", self._seq, reason])
        self._questions.put(None)

    def close(self) -> None:
        """Disconnects the client and removes its nodes from the graph."""
        self.is_closed = True
        self._bridge.clear()
        self._questions.put(None)
        self._connection.close()

    def _apply_answer(self, answer: Reply | Ended | Exception) -> bool:
        self._is_asked = self._holds = False
        if isinstance(answer, ProtocolError):
            raise answer
        if isinstance(answer, Exception):  # it has disconnected
            self.close()
            return False
        if answer.seq != self._seq:
            raise ProtocolError("an answer to a question that was not asked")
        self._bridge.apply_events(answer.events)
        if isinstance(answer, Ended):
            # Not close(): its last messages are still on their way through the graph.
            self._bridge.clear()
            self.is_closed = True
            self._questions.put(None)
            return True
        self._is_waiting = True
        self._wake_ns = answer.wake_ns
        self._holds = answer.wake_ns == HOLD_NS
        return bool(answer.events)

    def _send_news(self) -> None:
        """Sends the oldest messages, all of one instant, so that the client knows their time."""
        pending, now = self._bridge.pending, self._graph.now_ns
        time_ns = pending[0].time_ns if pending and not self._holds else now
        if self._holds:
            count = len(pending)
        elif (woken_ns := self._woken_ns()) < time_ns <= now:
            time_ns, count = woken_ns, 0
        else:
            count = next((i for i, entry in enumerate(pending) if entry.time_ns != time_ns), len(pending))
        events = [*self._bridge.take_changes(), *(entry.event for entry in pending[:count])]
        del pending[:count]
        self._seq += 1
        self._sent_ns = time_ns
        self._is_waiting = False
        self._is_asked = True
        self._questions.put(["tick", self._seq, time_ns, events])

    def _woken_ns(self) -> int:
        """The latest tick's time, or that of the tick in which it was to wake and could not, because it had not answered yet:
        so its timers keep their instants on a busy machine, and it catches up as soon as it can [ns]."""
        now, wake = self._graph.now_ns, self._wake_ns
        if wake is None or now < self._sent_ns:
            return now
        due = now
        if now - wake <= MAX_LATE_NS:
            due = next((each for each in self._ticks if each >= wake and each > self._sent_ns), now)
        late_ns = now - due
        self._falling_behind = self._falling_behind + 1 if late_ns > self._late_ns else 0
        if self._falling_behind > MAX_FALLING_BEHIND:
            due, late_ns, self._falling_behind = now, 0, 0
        self._late_ns = late_ns
        return due

    def _serve(self) -> None:
        """Sends questions and receives answers, in the client's own thread."""
        try:
            while (question := self._questions.get()) is not None:
                self._connection.send(question)
                if question[0] == "refused":
                    return
                answer = parse(self._connection.receive())
                if not isinstance(answer, (Reply, Ended)):
                    raise ProtocolError("another kind of answer")
                self._answers.put(answer)
                self._wake()
        except (EOFError, OSError, ProtocolError) as problem:
            self._answers.put(problem)
            self._wake()
        finally:
            self._connection.close()


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

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def client_count(self) -> int:
        """The number of connected clients."""
        return len(self._clients)

    def owed_answers(self) -> dict[int, bool]:
        """Returns the connected programs by process id, and whether the world waits for the answer of each."""
        return {client.pid: client.owes_answer for client in self._clients if client.pid is not None}

    def exchange(self) -> bool:
        """Adds new clients and exchanges messages with all of them. True if any client sent something.

        Waits for none but a program that enters the graph: so its timers begin at the instant that its clock shows."""
        if not self._clients and self._accepted.empty():
            return False
        while not self._accepted.empty():
            self._add_client(self._accepted.get())
        has_sent = False
        for client in self._clients:
            try:
                has_sent |= client.exchange()
                if client.is_waited_for:
                    has_sent |= client.wait_for_answer()
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
                LOGGER_NAME, f"{MAX_CLIENTS} terminals are already connected; another was refused"
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
