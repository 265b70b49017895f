"""The server's end of one connection: sends a client the graph's changes and messages, without ever waiting for it."""

from __future__ import annotations

import threading
from collections.abc import Callable
from queue import SimpleQueue
from typing import Final

import kit
from kit.host.graph_bridge import ParentBridge
from kit.host.protocol import Ended, Reply, parse
from kit.host.wire import Json, ProtocolError
from kit.inspection.framed_socket import FramedSocket
from kit.ros.graph.graph import Graph

MAX_BACKLOG: Final = 20_000
"""Messages that may wait for a client. One that is farther behind no longer reads and is disconnected."""


class ClientConnection:
    """One connected terminal. ``exchange`` is called in the world's thread.

    Its own thread does nothing but wait: for the client's answer, then for the world's next question. So a
    client costs the world no more than what it asks for, however slow it is.
    """

    def __init__(
        self, connection: FramedSocket, graph: Graph, world: str, wake: Callable[[], object]
    ) -> None:
        self._connection = connection
        self._graph = graph
        self._wake = wake
        self._bridge = ParentBridge(graph, shares_interfaces=True)
        self._questions: SimpleQueue[list[Json] | None] = SimpleQueue()
        self._answers: SimpleQueue[Reply | Ended | Exception] = SimpleQueue()
        self._seq = 0
        self._sent_ns = graph.now_ns
        self._wake_ns: int | None = None
        self._is_waiting = False
        self._is_asked = True
        """Whether an answer is still to come."""
        self.is_closed = False
        start = {
            "version": kit.__version__,
            "world": world,
            "now": self._sent_ns,
            "events": self._bridge.take_changes(),
        }
        self._questions.put(["start", 0, start])
        threading.Thread(target=self._serve, name="inspection-client", daemon=True).start()

    def exchange(self) -> bool:
        """Applies the client's answer if one has come, and sends what is new. True if the client sent something.

        Raises ProtocolError for an answer that makes no sense.
        """
        has_sent = not self._answers.empty() and self._apply_answer(self._answers.get())
        now = self._graph.now_ns
        has_woken = self._wake_ns is not None and self._wake_ns <= now and now != self._sent_ns
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
        self._is_asked = False
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
        return bool(answer.events)

    def _send_news(self) -> None:
        """Sends the oldest messages, all of one instant, so that the client knows their time."""
        pending = self._bridge.pending
        time_ns = pending[0].time_ns if pending else self._graph.now_ns
        count = next((i for i, entry in enumerate(pending) if entry.time_ns != time_ns), len(pending))
        events = [*self._bridge.take_changes(), *(entry.event for entry in pending[:count])]
        del pending[:count]
        self._seq += 1
        self._sent_ns = time_ns
        self._is_waiting = False
        self._is_asked = True
        self._questions.put(["tick", self._seq, time_ns, events])

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
