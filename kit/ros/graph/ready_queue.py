"""What is to be done next for some nodes, in order: the queue that an executor, or lock-step, works through.

Everything that became ready waits in one line, in the order in which it became ready: messages, requests and
responses as they arrive; timers when their time comes, by due time and then by age. So the same inputs give
the same order, always.
"""

from __future__ import annotations

from collections import deque
from heapq import heapify, heappop, heappush
from types import CoroutineType
from typing import TYPE_CHECKING, Any, Final, NamedTuple, Protocol

if TYPE_CHECKING:
    from kit.ros.execution.callback_groups import CallbackGroup
    from kit.ros.graph.graph import Graph
    from kit.ros.graph.node_handle import NodeHandle
    from kit.ros.node.timer import Timer

NO_WORK: Final = object()
"""What ``take`` returns when the work is gone: cancelled, destroyed, or already done."""


class ReadyItem(Protocol):
    """Something whose turn can come: a subscription, timer, service, client, guard condition or task."""

    @property
    def handle(self) -> NodeHandle | None:
        """Whose it is: its node's."""

    @property
    def callback_group(self) -> CallbackGroup | None:
        """What it must not overlap with."""

    def take(self) -> Any:
        """The work itself, taken out of its queue; or NO_WORK. Called with the graph's lock held."""

    def run(self, taken: Any) -> Any:
        """Does the work. A coroutine that it returns is carried on by the ready_queue."""


class TakenWork(NamedTuple):
    """One turn of an item."""

    item: ReadyItem
    taken: Any


class ReadyQueue:
    """The line of ready items and the timers of the nodes that belong to one executor."""

    def __init__(self, graph: Graph, *, exclusive: bool = True) -> None:
        self.graph = graph
        self.exclusive = exclusive
        """Whether one callback at a time is done here: what waits for another one would wait for ever."""
        self.items: deque[ReadyItem] = deque()
        self._timers: list[tuple[int, int, Timer]] = []

    def put(self, item: ReadyItem) -> None:
        """Puts an item at the end of the line. Any thread."""
        graph = self.graph
        with graph.lock:
            self.items.append(item)
            graph.notify()

    def add_timer(self, timer: Timer) -> None:
        """Has the timer's turn come at its ``due_ns``. An entry made for another due time is void."""
        graph = self.graph
        with graph.lock:
            heappush(self._timers, (timer.due_ns, timer.number, timer))
            graph.notify()

    @property
    def has_due_work(self) -> bool:
        """Whether anything may be ready now."""
        return bool(self.items) or bool(self._timers and self._timers[0][0] <= self.graph.now_ns)

    @property
    def next_due_ns(self) -> int | None:
        """When the next timer is due; None without timers."""
        timers = self._timers
        with self.graph.lock:
            while timers and timers[0][0] != timers[0][2].due_ns:
                heappop(timers)
            return timers[0][0] if timers else None

    def enqueue_due_timers(self) -> int:
        """Moves the timers that are due into the line, and says how long the line is now."""
        timers = self._timers
        if timers:
            now = self.graph.now_ns
            while timers and timers[0][0] <= now:
                due, _, timer = heappop(timers)
                if due == timer.due_ns:
                    self.items.append(timer)
        return len(self.items)

    def take_next(self) -> TakenWork | None:
        """The first work in line that may begin now; it must then be performed. None if there is none."""
        with self.graph.lock:
            self.enqueue_due_timers()
            items = self.items
            while items:
                item = items.popleft()
                group = item.callback_group
                if group is not None and not group.beginning_execution(item):
                    group.waiting_items.append(item)
                    continue
                taken = item.take()
                if taken is not NO_WORK:
                    return TakenWork(item, taken)
                if group is not None:
                    self._release_group(group, item)
        return None

    def execute(self, work: TakenWork) -> None:
        """Does the work in the calling thread. What its callback raises comes out of here."""
        item, taken = work
        thread_state = self.graph.thread_state
        outer = thread_state.work
        thread_state.work = (self, item)
        try:
            result = item.run(taken)
        except BaseException:
            self.finish(item)
            raise
        finally:
            thread_state.work = outer
        if type(result) is CoroutineType:
            from kit.ros.execution.task import Task

            task: Task[Any] = Task(result)
            task.continue_for(item, self)
            self.execute(TakenWork(task, None))
        else:
            self.finish(item)

    def finish(self, item: ReadyItem) -> None:
        """The item's turn is over: whoever waited for its callback group is first in line now."""
        group = item.callback_group
        if group is not None:
            with self.graph.lock:
                self._release_group(group, item)

    def _release_group(self, group: CallbackGroup, item: ReadyItem) -> None:
        group.ending_execution(item)
        if group.waiting_items:
            while group.waiting_items:
                waiting = group.waiting_items.pop()
                home = self if waiting.handle is None else waiting.handle.ready_queue
                home.items.appendleft(waiting)
            self.graph.notify()

    def take_over_node(self, handle: NodeHandle, other: ReadyQueue) -> None:
        """Takes over everything that is to be done for a node from another ready_queue, in its order."""
        if other is self:
            return
        with self.graph.lock:
            mine = [item for item in other.items if item.handle is handle]
            if mine:
                self.items.extend(mine)
                kept = [item for item in other.items if item.handle is not handle]
                other.items.clear()
                other.items.extend(kept)
            timers = [entry for entry in other._timers if entry[2].handle is handle]
            if timers:
                other._timers = [entry for entry in other._timers if entry[2].handle is not handle]
                heapify(other._timers)
                self._timers += timers
                heapify(self._timers)
            self.graph.notify()
