"""Waiters of a child's graph: block until the parent's next tick.

A tick is answered when nothing is left to do, that is, when every thread of the program waits in its graph. Threads
that do not are waited for briefly if they block elsewhere, and while they compute for a share of the processor time that the
answer may take, so that a busy machine decides nothing; then they are left out until they come back: their messages go with a
later answer. A thread that says that it waits for the user (``waiting_for_user``) is left out at
once; where it is the only one, a thread of the waiter's own answers the ticks, at most in real time.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Final, Protocol

if TYPE_CHECKING:
    from kit.ros.graph.graph import Graph

OTHER_THREAD_WAIT_S: Final = 0.05
"""How long to wait for a thread that has never waited in the graph, while nothing computes."""
MAX_OTHER_WAIT_S: Final = 2.0
"""How long to wait for it at most while something computes, it or another thread."""
CALLBACK_WAIT_S: Final = 0.5
"""How long to wait for a callback in a pool, and for a thread that has waited in the graph before, while nothing computes."""
MAX_COMPUTING_FACTOR: Final = 10.0
"""How many times as long to wait for them at most while something computes: it may be another thread."""
PAUSE_S: Final = 0.01
"""The waits above are this many pauses of this length in which nothing changed."""
COMPUTED_S: Final = 0.001
"""The processor time of a pause from which something other than the pause itself has computed [s]."""
MAX_PAUSE_S: Final = 0.1
"""How long an answer waits at most to keep the run from going faster than the user's clock."""


class TickSource(Protocol):
    """Ends a tick, and begins the next one."""

    def next_tick(self, wake_ns: int | None) -> None:
        """Answers that the program waits, until ``wake_ns`` at the latest, and applies the next tick."""


class SingleThreadWaiter:
    """The waiter of a graph that one thread uses, whatever other threads its process has."""

    def __init__(self, ticks: TickSource) -> None:
        self._ticks = ticks

    def is_alone(self, graph: Graph) -> bool:
        """Always."""
        return True

    def wait(self, graph: Graph, until_ns: int | None) -> None:
        """Called by that thread when it waits."""
        self._ticks.next_tick(until_ns)


class AllThreadsWaiter:
    """The waiter of a program with any number of threads: a tick ends when all of them wait."""

    def __init__(self, ticks: TickSource) -> None:
        self._ticks = ticks
        self._expected: set[int] = set()
        """Threads that have waited in the graph, and are worth a longer wait."""
        self._absent: set[int] = set()
        """Threads that a tick has ended without."""
        self._unreliable: set[int] = set()
        """Threads that a tick has ever ended without: not worth a longer wait again."""
        self._abandoned_callbacks = 0
        """How many running callbacks a tick has ended without."""
        self._users: dict[int, int] = {}
        """Threads that wait for the user, and how many times over: one such wait may be within another."""
        self._user_began = (0.0, 0)
        """When the first of them began: on the monotonic clock [s], and in the graph's time [ns]."""
        self._substitute: threading.Thread | None = None
        """The thread that answers ticks while the others wait for the user."""
        self.max_computing_s = CALLBACK_WAIT_S
        """How much processor time of a tick may have passed when threads that compute are no longer waited for [s]."""
        self._tick_began_s = time.process_time()

    def is_alone(self, graph: Graph) -> bool:
        """Whether the program has no other thread: what others are doing at the moment differs from machine to machine."""
        return threading.active_count() == 1

    def wait(self, graph: Graph, until_ns: int | None) -> None:
        """Called by the first thread that waits. Returns when there may be something to do."""
        with graph.lock:
            if not (self._wait_for_other_threads(graph) and self._wait_for_real_time(graph)):
                return
            if graph.settling:
                started = [
                    thread.ident for thread in threading.enumerate()
                ]  # in the order in which they started
                graph.settling.discard(
                    next((each for each in started if each in graph.settling), min(graph.settling))
                )
                graph.count_change()
                return
            wakes = [
                thread.until_ns for thread in graph.waiting_threads.values() if thread.until_ns is not None
            ]
            if self._absent or self._abandoned_callbacks or self._users:
                wakes.append(graph.now_ns)  # they may publish at any time: ask for every tick
        self._ticks.next_tick(min(wakes, default=None))
        self._tick_began_s = time.process_time()

    @contextmanager
    def waiting_for_user(self, graph: Graph) -> Iterator[None]:
        """Marks the calling thread as one that waits for the user: ticks are answered without it meanwhile."""
        me = threading.get_ident()
        with graph.lock:
            if not self._users:
                self._user_began = (time.monotonic(), graph.now_ns)
            self._users[me] = self._users.get(me, 0) + 1
            if self._substitute is None:
                self._substitute = threading.Thread(
                    target=self._answer_for_users, args=(graph,), name="ticks", daemon=True
                )
                self._substitute.start()
            graph.wait_started.notify_all()
        try:
            yield
        finally:
            with graph.lock:
                self._users[me] -= 1
                if not self._users[me]:
                    del self._users[me]
                graph.wait_started.notify_all()
                graph.notify()

    def _answer_for_users(self, graph: Graph) -> None:
        while True:
            graph.wait(lambda: not self._users)
            with graph.lock:
                if not self._users:
                    self._substitute = None
                    return

    def _wait_for_real_time(self, graph: Graph) -> bool:
        """Waits, while a thread waits for the user, until the next tick is due in real time; False as the other does."""
        seen = graph.change_count
        began_s, began_ns = self._user_began
        end = min(began_s + (graph.now_ns - began_ns) / 1e9, time.monotonic() + MAX_PAUSE_S)
        while self._users and graph.change_count == seen and (left := end - time.monotonic()) > 0:
            graph.wait_started.wait(left)
        return graph.change_count == seen

    def _wait_for_other_threads(self, graph: Graph) -> bool:
        """Waits until all threads wait or time is up; False if there is something to do for this one meanwhile."""
        me, waited_s, idle_s, seen_s = threading.get_ident(), 0.0, 0.0, time.process_time()
        while True:
            waiting = graph.waiting_threads
            if waiting[me].seen_changes != graph.change_count:
                return False
            self._expected |= waiting.keys() - self._unreliable
            self._absent -= waiting.keys()
            is_waking = any(thread.seen_changes != graph.change_count for thread in waiting.values())
            callbacks = graph.running_pool_callbacks - sum(thread.is_pooled for thread in waiting.values())
            self._abandoned_callbacks = min(self._abandoned_callbacks, callbacks)
            others = {
                thread.ident
                for thread in threading.enumerate()
                if thread.ident is not None and thread not in graph.pool_threads
            }
            others -= waiting.keys() | self._absent | self._users.keys()
            if self._substitute is not None and self._substitute.ident is not None:
                others.discard(self._substitute.ident)
            has_callbacks = callbacks > self._abandoned_callbacks
            if not (is_waking or others or has_callbacks):
                return True
            is_expected = has_callbacks or bool(others & self._expected)
            has_time = idle_s < (CALLBACK_WAIT_S if is_expected else OTHER_THREAD_WAIT_S)
            has_time &= waited_s < (
                MAX_COMPUTING_FACTOR * CALLBACK_WAIT_S if is_expected else MAX_OTHER_WAIT_S
            )
            has_time &= seen_s - self._tick_began_s < self.max_computing_s
            if not (has_time or is_waking):
                self._absent |= others
                self._unreliable |= others
                self._expected -= others
                self._abandoned_callbacks = callbacks
                return True
            # Not by the clock: on a busy machine a pause takes longer, and so do the threads that are waited for.
            if not graph.wait_started.wait(PAUSE_S):
                before_s, seen_s = seen_s, time.process_time()
                waited_s += PAUSE_S
                idle_s = 0.0 if seen_s - before_s > COMPUTED_S else idle_s + PAUSE_S
