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

NOTHING: Final = object()
"""What ``take`` returns when the work is gone: cancelled, destroyed, or already done."""


class Item(Protocol):
    """Something whose turn can come: a subscription, timer, service, client, guard condition or task."""

    @property
    def handle(self) -> NodeHandle | None:
        """Whose it is: its node's."""

    @property
    def callback_group(self) -> CallbackGroup | None:
        """What it must not overlap with."""

    def take(self) -> Any:
        """The work itself, taken out of its queue; or NOTHING. Called with the graph's lock held."""

    def run(self, taken: Any) -> Any:
        """Does the work. A coroutine that it returns is carried on by the agenda."""


class Work(NamedTuple):
    """One turn of an item."""

    item: Item
    taken: Any


class Agenda:
    """The line of ready items and the timers of the nodes that belong to one executor."""

    def __init__(self, graph: Graph, *, exclusive: bool = True) -> None:
        self.graph = graph
        self.exclusive = exclusive
        """Whether one callback at a time is done here: what waits for another one would wait for ever."""
        self.ready: deque[Item] = deque()
        self._timers: list[tuple[int, int, Timer]] = []

    def post(self, item: Item) -> None:
        """Puts an item at the end of the line. Any thread."""
        graph = self.graph
        with graph.lock:
            self.ready.append(item)
            graph.notify()

    def add_timer(self, timer: Timer) -> None:
        """Has the timer's turn come at its ``due_ns``. An entry made for another due time is void."""
        graph = self.graph
        with graph.lock:
            heappush(self._timers, (timer.due_ns, timer.number, timer))
            graph.notify()

    @property
    def is_due(self) -> bool:
        """Whether anything may be ready now."""
        return bool(self.ready) or bool(self._timers and self._timers[0][0] <= self.graph.now_ns)

    @property
    def next_due_ns(self) -> int | None:
        """When the next timer is due; None without timers."""
        timers = self._timers
        with self.graph.lock:
            while timers and timers[0][0] != timers[0][2].due_ns:
                heappop(timers)
            return timers[0][0] if timers else None

    def line_up_timers(self) -> int:
        """Moves the timers that are due into the line, and says how long the line is now."""
        timers = self._timers
        if timers:
            now = self.graph.now_ns
            while timers and timers[0][0] <= now:
                due, _, timer = heappop(timers)
                if due == timer.due_ns:
                    self.ready.append(timer)
        return len(self.ready)

    def pick(self) -> Work | None:
        """The first work in line that may begin now; it must then be performed. None if there is none."""
        with self.graph.lock:
            self.line_up_timers()
            ready = self.ready
            while ready:
                item = ready.popleft()
                group = item.callback_group
                if group is not None and not group.beginning_execution(item):
                    group.parked.append(item)
                    continue
                taken = item.take()
                if taken is not NOTHING:
                    return Work(item, taken)
                if group is not None:
                    self._free(group, item)
        return None

    def perform(self, work: Work) -> None:
        """Does the work in the calling thread. What its callback raises comes out of here."""
        item, taken = work
        performing = self.graph.performing
        outer = performing.work
        performing.work = (self, item)
        try:
            result = item.run(taken)
        except BaseException:
            self.end(item)
            raise
        finally:
            performing.work = outer
        if type(result) is CoroutineType:
            from kit.ros.execution.task import Task

            task: Task[Any] = Task(result)
            task.continue_for(item, self)
            self.perform(Work(task, None))
        else:
            self.end(item)

    def end(self, item: Item) -> None:
        """The item's turn is over: whoever waited for its callback group is first in line now."""
        group = item.callback_group
        if group is not None:
            with self.graph.lock:
                self._free(group, item)

    def _free(self, group: CallbackGroup, item: Item) -> None:
        group.ending_execution(item)
        if group.parked:
            while group.parked:
                waiting = group.parked.pop()
                home = self if waiting.handle is None else waiting.handle.agenda
                home.ready.appendleft(waiting)
            self.graph.notify()

    def adopt(self, handle: NodeHandle, other: Agenda) -> None:
        """Takes over everything that is to be done for a node from another agenda, in its order."""
        if other is self:
            return
        with self.graph.lock:
            mine = [item for item in other.ready if item.handle is handle]
            if mine:
                self.ready.extend(mine)
                kept = [item for item in other.ready if item.handle is not handle]
                other.ready.clear()
                other.ready.extend(kept)
            timers = [entry for entry in other._timers if entry[2].handle is handle]
            if timers:
                other._timers = [entry for entry in other._timers if entry[2].handle is not handle]
                heapify(other._timers)
                self._timers += timers
                heapify(self._timers)
            self.graph.notify()
