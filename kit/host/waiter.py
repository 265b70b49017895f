"""How a student's program waits: for the kit's next question. Whatever blocks in it ends up here.

A question is one tick. It is answered when nothing is left to do, that is, when every thread of the program
waits. Threads that never wait here (one that computes, or waits for something of its own) are waited for a
moment and then left out until they come back: their messages go with whichever answer is next.
"""

from __future__ import annotations

import threading
import time
from typing import TYPE_CHECKING, Final, Protocol

if TYPE_CHECKING:
    from kit.ros.graph.graph import Graph

STRANGER_S: Final = 0.05
"""How long to wait for a thread that does not wait here."""
CALLBACK_S: Final = 0.5
"""How long to wait for a callback in a thread of its own."""


class Exchange(Protocol):
    """One answer, one question."""

    def turn(self, wake_ns: int | None) -> None:
        """Answers that the program waits, until ``wake_ns`` at the latest, and takes in the next question."""


class SingleThreadWaiter:
    """The pump of a program that has one thread in its graph, whatever others there are in its process."""

    def __init__(self, exchange: Exchange) -> None:
        self._exchange = exchange

    def wait(self, graph: Graph, until_ns: int | None) -> None:
        """Called by that thread when it waits."""
        self._exchange.turn(until_ns)


class AllThreadsWaiter:
    """The ``Waiter`` of a graph whose time and messages come through the pipe."""

    def __init__(self, exchange: Exchange) -> None:
        self._exchange = exchange
        self._regulars: set[int] = set()
        self._away: set[int] = set()
        self._fickle: set[int] = set()
        """Threads that were once waited for in vain: not worth more than a moment again."""
        self._given_up = 0

    def wait(self, graph: Graph, until_ns: int | None) -> None:
        """Called by the first thread that waits. Returns when there may be something to do."""
        with graph.lock:
            if not self._everybody_waits(graph):
                return
            wakes = [look.until_ns for look in graph.waiting_threads.values() if look.until_ns is not None]
            if self._away or self._given_up:
                wakes.append(graph.now_ns)  # they may have something to say at any time: ask at every tick
        self._exchange.turn(min(wakes, default=None))

    def _everybody_waits(self, graph: Graph) -> bool:
        """Waits for the other threads, within reason; false if there is something to do for this one meanwhile."""
        me, began = threading.get_ident(), time.monotonic()
        while True:
            looks = graph.waiting_threads
            if looks[me].seen_changes != graph.change_count:
                return False
            self._regulars |= looks.keys() - self._fickle
            self._away -= looks.keys()
            waking = any(look.seen_changes != graph.change_count for look in looks.values())
            busy = graph.running_pool_callbacks - sum(look.is_pooled for look in looks.values())
            self._given_up = min(self._given_up, busy)
            strangers = {thread.ident for thread in threading.enumerate() if thread.ident is not None}
            strangers -= looks.keys() | self._away
            if not (waking or strangers or busy > self._given_up):
                return True
            patience = CALLBACK_S if busy > self._given_up or strangers & self._regulars else STRANGER_S
            if time.monotonic() - began > patience and not waking:
                self._away |= strangers
                self._fickle |= strangers
                self._regulars -= strangers
                self._given_up = busy
                return True
            graph.wait_started.wait(STRANGER_S / 5)
