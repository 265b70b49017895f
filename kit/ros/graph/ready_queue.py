"""Queues the callbacks of some nodes in the order in which they became ready; an executor or the lock-step runs them.

There is one queue: messages, requests and responses enter it as they arrive; timers when they are due, by due time
and then by age. So the same inputs always give the same order.
"""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable
from contextlib import AbstractContextManager
from heapq import heapify, heappop, heappush
from types import CoroutineType
from typing import Any, Protocol

from kit.ros.execution.callback_groups import (
    NO_WORK,
    CallbackGroup,
    ItemOwner,
    MutuallyExclusiveCallbackGroup,
    ReadyItem,
    TakenWork,
)


class ThreadState(threading.local):
    """The work that the current thread is executing."""

    work: tuple[ReadyQueue, ReadyItem] | None = None
    is_pooled = False
    """Whether the thread belongs to a MultiThreadedExecutor."""
    reads = 0.0
    """How often the thread has read the clock, or asked for something else that it may wait for, since it last waited."""
    is_waiting = False
    """Whether it is within ``Graph.wait``, which calls functions of others to ask whether the wait is over."""


class QueueGraph(Protocol):
    """The part of a Graph that ready queues use."""

    @property
    def lock(self) -> AbstractContextManager[Any]: ...

    @property
    def thread_state(self) -> ThreadState: ...

    @property
    def now_ns(self) -> int: ...

    def notify(self) -> None: ...


class ReadyTimer(ReadyItem, Protocol):
    """A timer: an item that becomes ready at ``due_ns``."""

    @property
    def due_ns(self) -> int: ...

    @property
    def number(self) -> int: ...


class Continuation(ReadyItem, Protocol):
    """A coroutine as an item: a Task."""

    def continue_for(self, source: ReadyItem, ready_queue: ReadyQueue) -> None:
        """Ends the turn of ``source`` when the coroutine is done."""


class PolledItem(ReadyItem, Protocol):
    """An item that says itself, when it is asked, whether it has become ready: a node's waitable."""

    is_queued: bool

    def poll(self) -> bool:
        """True if it has become ready. With the graph's lock held."""


MakeContinuation = Callable[[Any], Continuation]
"""Turns a coroutine into an item: ``Task``."""


class ReadyQueue:
    """The ready items and the timers of the nodes that belong to one executor, or to the lock-step."""

    def __init__(
        self, graph: QueueGraph, make_continuation: MakeContinuation, *, is_exclusive: bool = True
    ) -> None:
        self.graph = graph
        self._lock, self._thread_state = graph.lock, graph.thread_state
        self._make_continuation = make_continuation
        self.is_exclusive = is_exclusive
        """Whether callbacks run one at a time, so that a callback that waits for another one never returns."""
        self.items: deque[ReadyItem] = deque()
        self._timers: list[tuple[int, int, ReadyTimer]] = []
        self.polled: list[PolledItem] = []
        """Asked whenever something has happened."""
        self._refused: list[ReadyItem] = []
        """Items that a program's own callback group has refused; it is asked again after each callback."""

    def put(self, item: ReadyItem) -> None:
        """Appends an item, from any thread."""
        graph = self.graph
        with graph.lock:
            self.items.append(item)
            graph.notify()

    def add_timer(self, timer: ReadyTimer) -> None:
        """Schedules the timer at its ``due_ns``; earlier entries of the timer become void."""
        graph = self.graph
        with graph.lock:
            heappush(self._timers, (timer.due_ns, timer.number, timer))
            graph.notify()

    @property
    def has_due_work(self) -> bool:
        """True if anything may be ready now."""
        if self.polled:
            self.enqueue_polled()
        return bool(self.items) or bool(self._timers and self._timers[0][0] <= self.graph.now_ns)

    @property
    def next_due_ns(self) -> int | None:
        """The time at which the next timer is due [ns]; None without timers."""
        timers = self._timers
        with self.graph.lock:
            while timers and timers[0][0] != timers[0][2].due_ns:
                heappop(timers)
            return timers[0][0] if timers else None

    def enqueue_due_timers(self) -> int:
        """Appends the timers that are due; returns the number of items."""
        timers = self._timers
        if timers:
            now = self.graph.now_ns
            with self._lock:
                while timers and timers[0][0] <= now:
                    due, _, timer = heappop(timers)
                    if due == timer.due_ns:
                        self.items.append(timer)
        return len(self.items)

    def enqueue_polled(self) -> None:
        """Appends the polled items that have become ready."""
        with self.graph.lock:
            for item in self.polled:
                if not item.is_queued and item.poll():
                    item.is_queued = True
                    self.items.append(item)

    def take_next(self, finished: ReadyItem | None = None) -> TakenWork | None:
        """Takes the first work that its callback group admits; it must then be executed. None if there is none.

        ``finished``: an item whose turn ends first, as by ``finish``.
        """
        with self._lock:
            if finished is not None:
                self._end_turn(finished)
            if self._timers:
                self.enqueue_due_timers()
            items = self.items
            while items:
                item = items.popleft()
                group = item.callback_group
                if group is not None and not group.beginning_execution(item):
                    if isinstance(group, MutuallyExclusiveCallbackGroup):
                        group.waiting_items.append(item)
                    else:
                        self._refused.append(item)
                    continue
                taken = item.take()
                if taken is not NO_WORK:
                    return item, taken
                if group is not None:
                    group.ending_execution(item)
                    self._put_back_waiting(group)
        return None

    def execute(self, work: TakenWork) -> None:
        """Runs the callback in the calling thread, and ends its turn. What the callback raises is raised here."""
        self.finish(self.run_callback(work))

    def run_callback(self, work: TakenWork) -> ReadyItem:
        """Runs the callback, and returns the item whose turn is to be ended: of a coroutine, the task that goes on with it."""
        item, taken = work
        thread_state = self._thread_state
        outer = thread_state.work
        thread_state.work = (self, item)
        try:
            result = item.run(taken)
        except BaseException:  # Ctrl-C too: the queue stays consistent; raised again
            self.finish(item)
            raise
        finally:
            thread_state.work = outer
        if type(result) is CoroutineType:
            task = self._make_continuation(result)
            task.continue_for(item, self)
            return self.run_callback((task, None))
        return item

    def finish(self, item: ReadyItem) -> None:
        """Ends the item's turn: the items that waited for its callback group go to the front."""
        with self._lock:
            self._end_turn(item)

    def _end_turn(self, item: ReadyItem) -> None:
        group = item.callback_group
        if group is not None:
            group.ending_execution(item)
            if group.waiting_items:
                self._put_back_waiting(group)
        if self._refused:  # they are asked again, in their order
            self.items.extendleft(reversed(self._refused))
            self._refused.clear()
            self.graph.notify()

    def _put_back_waiting(self, group: CallbackGroup) -> None:
        """Puts the items that wait for a group at the front."""
        if group.waiting_items:
            while group.waiting_items:
                waiting = group.waiting_items.pop()
                home = self if waiting.handle is None else waiting.handle.ready_queue
                home.items.appendleft(waiting)
            self.graph.notify()

    def take_over_node(self, handle: ItemOwner, other: ReadyQueue) -> None:
        """Moves the items and timers of a node here from another queue, in their order."""
        if other is self:
            return
        with self.graph.lock:
            mine = [item for item in other.items if item.handle is handle]
            if mine:
                self.items.extend(mine)
                kept = [item for item in other.items if item.handle is not handle]
                other.items.clear()
                other.items.extend(kept)
            self._refused += [item for item in other._refused if item.handle is handle]
            other._refused = [item for item in other._refused if item.handle is not handle]
            self.polled += [item for item in other.polled if item.handle is handle]
            other.polled = [item for item in other.polled if item.handle is not handle]
            timers = [entry for entry in other._timers if entry[2].handle is handle]
            if timers:
                other._timers = [entry for entry in other._timers if entry[2].handle is not handle]
                heapify(other._timers)
                self._timers += timers
                heapify(self._timers)
            self.graph.notify()
