"""The world's end of one visit: what the visitor is told and what it says, without ever waiting for it."""

from __future__ import annotations

import threading
from collections.abc import Callable
from queue import SimpleQueue
from typing import Final

import kit
from kit.host.parent_bridge import Delegation
from kit.host.protocol import Ended, Reply, parse
from kit.host.wire import Json, ProtocolError
from kit.inspection.framed_socket import Line
from kit.ros.graph.graph import Graph

FARTHEST_BEHIND: Final = 20_000
"""Messages that may wait for a visitor. One that is farther behind has stopped listening and is let go."""


class Visitor:
    """One terminal that has come in. ``exchange`` belongs to the world's thread.

    Its own thread does nothing but wait: for the visitor's answer, then for the world's next question. So a
    visitor costs the world no more than what it asks for, however slow it is.
    """

    def __init__(self, line: Line, graph: Graph, world: str, wake: Callable[[], object]) -> None:
        self._line = line
        self._graph = graph
        self._wake = wake
        self._delegation = Delegation(graph)
        self._questions: SimpleQueue[Json] = SimpleQueue()
        self._answers: SimpleQueue[Reply | Ended | Exception] = SimpleQueue()
        self._seq = 0
        self._told_ns = graph.now_ns
        self._wake_ns: int | None = None
        self._listens = False
        self.is_gone = False
        start = {
            "version": kit.__version__,
            "world": world,
            "now": self._told_ns,
            "events": self._delegation.news(),
        }
        self._questions.put(["start", 0, start])
        threading.Thread(target=self._converse, name="visitor", daemon=True).start()

    def exchange(self) -> bool:
        """Takes in an answer if one has come, and tells what there is to tell; whether something was said.

        ProtocolError if the visitor says something that it cannot mean.
        """
        said = not self._answers.empty() and self._take_in(self._answers.get())
        now = self._graph.now_ns
        has_woken = self._wake_ns is not None and self._wake_ns <= now and now != self._told_ns
        if self._listens and (self._delegation.has_news or has_woken or now < self._told_ns):
            self._tell()
        if len(self._delegation.inbox) > FARTHEST_BEHIND:
            raise ProtocolError(f"nothing any more: it is {FARTHEST_BEHIND} messages behind")
        return said

    def close(self) -> None:
        """Shows the visitor out and takes its nodes out of the graph."""
        self.is_gone = True
        self._delegation.clear()
        self._questions.put(None)
        self._line.close()

    def _take_in(self, answer: Reply | Ended | Exception) -> bool:
        if isinstance(answer, ProtocolError):
            raise answer
        if isinstance(answer, Exception):  # it has hung up
            self.close()
            return False
        if answer.seq != self._seq:
            raise ProtocolError("an answer to a question that was not asked")
        self._delegation.take_in(answer.events)
        if isinstance(answer, Ended):
            # Not close(): what it has said last is still on its way through the graph.
            self._delegation.clear()
            self.is_gone = True
            self._questions.put(None)
            return True
        self._listens = True
        self._wake_ns = answer.wake_ns
        return bool(answer.events)

    def _tell(self) -> None:
        """The next question: the oldest things to tell, all of one instant, so that the visitor sees when."""
        inbox = self._delegation.inbox
        time_ns = inbox[0].time_ns if inbox else self._graph.now_ns
        count = next((i for i, waiting in enumerate(inbox) if waiting.time_ns != time_ns), len(inbox))
        events = [*self._delegation.news(), *(waiting.event for waiting in inbox[:count])]
        del inbox[:count]
        self._seq += 1
        self._told_ns = time_ns
        self._listens = False
        self._questions.put(["tick", self._seq, time_ns, events])

    def _converse(self) -> None:
        """The visitor's own thread."""
        try:
            while (question := self._questions.get()) is not None:
                self._line.send(question)
                answer = parse(self._line.receive())
                if not isinstance(answer, (Reply, Ended)):
                    raise ProtocolError("another kind of answer")
                self._answers.put(answer)
                self._wake()
        except (EOFError, OSError, ProtocolError) as problem:
            self._answers.put(problem)
            self._wake()
        finally:
            self._line.close()
