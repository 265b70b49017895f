"""The graph: all nodes of a run, the messages between them, and their clock.

A graph is driven in one of two ways.

*Lock-step*: ``advance(time_ns)``, then ``run_due()``. All due callbacks of nodes that no executor spins run in the
calling thread, in the order in which they became ready, until none is left: a key press that causes a command that
causes a motion does so within one tick. Time does not advance meanwhile, so a callback that waits for something later
would never return; it gets an explanation (``WouldDeadlock``) instead.

*Free-running*: executors spin in threads of their own. Every wait in the library is ``Graph.wait``. How it waits
is up to the ``Waiter``: without one, on a condition variable, for the system's clock or for another thread's
``advance``; with one, the first thread that waits calls the waiter, and the others wait for that thread.

Messages are copied, as a network would: a publisher may change its message after ``publish``, and no subscription
is affected by what another does with its copy. ``Publisher.publish_without_copy`` saves one of the copies.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Any, NamedTuple, Protocol
from weakref import WeakSet

from kit.ros.exceptions import NodeFailure, WouldDeadlock
from kit.ros.execution.callback_groups import TakenWork
from kit.ros.execution.task import Task
from kit.ros.graph.directory import Directory, NodeLike
from kit.ros.graph.ready_queue import ReadyQueue, ThreadState
from kit.ros.log import LoggerSettings, LogSink, log_to_stderr

MAX_ROUNDS = 100
"""Rounds of callbacks in one ``run_due``; messages that are left then wait for the next tick."""

MAX_CALLBACKS = 10_000
"""Callbacks in one ``run_due``, likewise."""


MAX_POLLS = 100
"""How often a program may poll without waiting at one instant before it must wait all the same: otherwise
``while rclpy.ok(): rclpy.spin_once(node, timeout_sec=0)`` would keep the time from advancing."""
MAX_READS = 100
"""How often a thread may read the clock without waiting before each further ``READS_PER_STEP`` reads let a step of the
simulated time pass. So a loop that waits until the clock shows a time ends, and takes as many reads on every machine."""
READS_PER_STEP = 10


class Waiter(Protocol):
    """Waits for a program whose time and messages come from another process."""

    def is_alone(self, graph: Graph) -> bool:
        """Whether the calling thread is the only one that may use the graph."""

    def wait(self, graph: Graph, until_ns: int | None) -> None:
        """Returns when something may have changed: time was advanced, messages were published, a shutdown.

        Called in the waiting thread, without the graph's lock. ``until_ns``: the time-out of that thread; others may
        have an earlier one, so it is a hint.
        """


class TimeJumpListener(Protocol):
    """Is told when the simulated time is set, with the graph's lock held; the difference is in nanoseconds."""

    def before_jump(self, delta_ns: int) -> None: ...

    def after_jump(self, delta_ns: int) -> None: ...


MessageListener = Callable[[int, NodeLike, str, Any], None]
"""``(time_ns, node, topic, message)``: called for every message published, every request and every response.

The name of a request's or response's service takes the place of the topic. The message is the sender's own:
copy it to keep it. Called with the graph's lock held: be quick.
"""


class WaitingThread(NamedTuple):
    """The state of a thread that waits in ``Graph.wait``. A waiter waits while no thread has missed a change."""

    until_ns: int | None
    """When its time-out ends [ns]; None: never."""
    seen_changes: int
    """``Graph.change_count`` when it began to wait."""
    is_pooled: bool
    """True for a thread of a MultiThreadedExecutor: ``Graph.running_pool_callbacks`` counts it."""


class Graph:
    """All nodes of a run. ``start_ns``: simulated time from there on; None: the system's time."""

    def __init__(
        self, start_ns: int | None = 0, *, waiter: Waiter | None = None, log_sink: LogSink = log_to_stderr
    ) -> None:
        self.lock = threading.RLock()
        self.waiter = waiter
        self.on_failure: Callable[[NodeFailure], None] | None = None
        """Called when a callback fails in lock-step; without it, ``run_due`` raises."""
        self.message_listeners: tuple[MessageListener, ...] = ()
        self.thread_state = ThreadState()
        self.log = LoggerSettings(lambda: self.now_ns, log_sink)
        self.directory = Directory(self.log, self.notify)
        """All nodes, topics and services."""
        self.has_subscriptions: Callable[[str], bool] = self.directory.subscribed_topics.__contains__
        """Whether anything subscribes to a topic, by its absolute name; asked several times in each tick."""
        self.reserved_names: set[str] = set()
        """Full names that belong to the run's own nodes: a program's process may not give them to its nodes."""
        self.shared_context: Any = None
        """Set by ``execution.context.context_of``; untyped, since contexts are built on graphs."""
        self.ready_queue = ReadyQueue(self, Task)
        """The callbacks of the nodes that no executor spins."""
        self._simulated_ns = start_ns
        self._system_offset_ns = time.time_ns() - time.monotonic_ns()
        self.change_count = 0
        """The number of calls of ``notify``: of changes that may end a wait."""
        self.waiting_threads: dict[int, WaitingThread] = {}
        """The threads in ``wait``, by their identifiers."""
        self.running_pool_callbacks = 0
        """The number of callbacks that run in the pools of MultiThreadedExecutors."""
        self.settling: set[int] = set()
        """The threads whose time has come and that wait until no other one has anything to do; the waiter takes them out."""
        self.pool_threads: WeakSet[threading.Thread] = WeakSet()
        """The threads of these pools, which are idle but for these callbacks."""
        self.wait_started = threading.Condition(self.lock)
        """Notified when a further thread begins to wait, and of every change; waiters use it."""
        self._changed = threading.Condition(self.lock)
        self.is_waiter_running = False
        """Whether a thread is in the waiter."""
        self._time_jump_count = 0
        self.time_jump_listeners: list[TimeJumpListener] = []
        self._driver_thread: int | None = None
        self._last_number = 0
        self._polls = (0, 0)
        self._reported_loops: set[tuple[str, ...]] = set()

    # Time

    @property
    def is_simulated(self) -> bool:
        return self._simulated_ns is not None

    @property
    def now_ns(self) -> int:
        """The time now [ns]: simulated, or the system's time made monotonic."""
        now = self._simulated_ns
        return time.monotonic_ns() + self._system_offset_ns if now is None else now

    def advance(self, time_ns: int) -> None:
        """Sets the simulated time. If it goes back, every timer and rate starts a new period."""
        before = self._simulated_ns
        if before is None:
            raise RuntimeError("this graph follows the system's clock; only a simulated one can be advanced")
        with self.lock:
            listeners = tuple(self.time_jump_listeners)
            for listener in listeners:
                listener.before_jump(time_ns - before)
            self._simulated_ns = time_ns
            for listener in listeners:
                listener.after_jump(time_ns - before)
            if time_ns < before:
                self._time_jump_count += 1
                for handle in self.directory.nodes:
                    handle.rewind()
            self.count_change()

    # Lock-step

    def run_due(self) -> int:
        """Runs all due callbacks of nodes that no executor spins, until none is left. Returns their number.

        Raises NodeFailure if a callback fails and ``on_failure`` is not set; the others wait for the next call. So
        do, after a warning, the messages of nodes that answer each other without end.
        """
        ready_queue = self.ready_queue
        self._driver_thread = threading.get_ident()
        if ready_queue.polled:
            ready_queue.enqueue_polled()
        done = rounds = left = 0  # left: of the round, which is what is ready when it begins
        finished = None
        try:
            while done < MAX_CALLBACKS and (left or rounds < MAX_ROUNDS):
                work = ready_queue.take_next(finished)
                finished = None
                if work is None:
                    return done
                if left:
                    left -= 1
                else:
                    rounds += 1
                    left = len(ready_queue.items)
                done += 1
                try:
                    finished = ready_queue.run_callback(work)
                except Exception as cause:  # noqa: BLE001 - raised again, or handed to who asked for failures
                    self._report_failure(work, cause)
        finally:
            if finished is not None:
                ready_queue.finish(finished)
        if ready_queue.has_due_work:
            self._warn_of_loop()
        return done

    def _report_failure(self, work: TakenWork, cause: Exception) -> None:
        handle = work[0].handle
        failure = NodeFailure(handle.full_name if handle is not None else None, cause)
        if self.on_failure is None:
            raise failure from cause
        self.on_failure(failure)

    def _warn_of_loop(self) -> None:
        with self.lock:
            loop = tuple(sorted({str(item) for item in self.ready_queue.items}))
        if loop not in self._reported_loops:
            self._reported_loops.add(loop)
            self.log.warning(
                "graph",
                f"{', '.join(loop)}: answered without end within one tick; the rest waits for the next. "
                "Does a node react to its own messages?",
            )

    def discard_messages(self) -> None:
        """Drops every queued message, request and response. Timers are not affected."""
        with self.lock:
            for handle in self.directory.nodes:
                handle.discard_queues()

    # Free-running

    def wait(
        self,
        ready: Callable[[], bool],
        until_ns: int | None = None,
        *,
        what: str = "this call",
        settles: bool = True,
    ) -> bool:
        """Waits until ``ready()``; False if ``until_ns`` is reached first or time jumps back meanwhile.

        ``settles``: when ``until_ns`` is reached, others first do what is due then; False for who does it.

        ``ready`` is called with the lock held. Raises WouldDeadlock, naming ``what``, if time and messages
        cannot advance while the calling thread waits.
        """
        state = self.thread_state
        with self.lock:
            jumps = self._time_jump_count
            state.is_waiting = True
            has_waited, has_settled = False, not settles
            try:
                while True:
                    if until_ns is not None and has_waited and not has_settled and self.now_ns >= until_ns:
                        has_settled = True
                        if self.waiter is not None:
                            self._settle(self.waiter)
                    if ready():
                        return True
                    if until_ns is not None and (self.now_ns >= until_ns or jumps != self._time_jump_count):
                        if self._is_polling_too_often():
                            self._wait_once(until_ns)
                        return False
                    self._raise_if_deadlock(what)
                    self._wait_once(until_ns)
                    has_waited = True
            finally:
                state.is_waiting = False

    def _settle(self, waiter: Waiter) -> None:
        """Lets the other threads do first what is due at this instant: so a thread whose time has come finds the same on every machine."""
        me = threading.get_ident()
        if waiter.is_alone(self):
            return
        self.settling.add(me)
        while me in self.settling:
            self._wait_once(self.now_ns)

    def count_read(self, weight: float = 1.0) -> None:
        """To be called when a program reads the clock, or asks whether something has happened, of its own accord.

        A program that does so again and again without waiting waits by that: see ``MAX_READS``. ``weight``: how many
        readings this one stands for.
        """
        if self.waiter is None or self._simulated_ns is None:
            return
        state = self.thread_state
        if state.is_waiting:
            return
        state.reads += weight
        if state.reads >= MAX_READS + READS_PER_STEP:
            now = self._simulated_ns
            self.wait(lambda: self.now_ns != now, now + 1)
            state.reads = MAX_READS

    def notify(self) -> None:
        """Wakes all waiting threads so that they re-check their condition."""
        with self.lock:
            self.count_change()

    def count_change(self) -> None:
        """Does what ``notify`` does, with the lock already held."""
        self.change_count += 1
        if self.waiting_threads:
            self._changed.notify_all()
            if self.is_waiter_running:
                self.wait_started.notify_all()  # a waiter that waits for other threads is not among them

    def _wait_once(self, until_ns: int | None) -> None:
        me = threading.get_ident()
        self.thread_state.reads = 0
        self.waiting_threads[me] = WaitingThread(until_ns, self.change_count, self.thread_state.is_pooled)
        try:
            if self.waiter is None or self.is_waiter_running:
                self.wait_started.notify_all()
                timeout = None if until_ns is None or self.is_simulated else (until_ns - self.now_ns) / 1e9
                self._changed.wait(timeout)
                return
            self.is_waiter_running = True
            self.wait_started.notify_all()
            self.lock.release()
            try:
                self.waiter.wait(self, until_ns)
            finally:
                self.lock.acquire()
                self.is_waiter_running = False
                self._changed.notify_all()
        finally:
            del self.waiting_threads[me]

    def _is_polling_too_often(self) -> bool:
        """True if a program with a waiter has polled so often at this instant that time must advance first."""
        now = self.now_ns
        instant, count = self._polls
        count = count + 1 if instant == now else 1
        self._polls = (now, count)
        if self.waiter is None or count <= MAX_POLLS:
            return False
        self._polls = (now, 0)
        return True

    def _raise_if_deadlock(self, what: str) -> None:
        work = self.thread_state.work
        if work is not None and work[0] is self.ready_queue:
            raise WouldDeadlock(
                f"{what} would wait forever: the nodes run in lock-step here, and time does not advance until this "
                "callback returns. Return, and continue in a later callback: add_done_callback, await, or a timer."
            )
        if self.waiter is None and self.is_simulated and self._driver_thread == threading.get_ident():
            raise WouldDeadlock(f"{what} would wait forever: this thread itself advances the time")

    # Nodes and listeners

    @property
    def nodes(self) -> tuple[NodeLike, ...]:
        """Nodes in the order of their creation."""
        return tuple(handle.node for handle in self.directory.nodes)

    def subscription_count(self, topic: str) -> int:
        """The number of subscriptions of a topic, by its absolute name."""
        found = self.directory.topics.get(topic)
        return len(found.subscriptions) if found is not None else 0

    def add_message_listener(self, listener: MessageListener) -> Callable[[], None]:
        """Calls ``listener`` for every message, until the returned function is called."""
        with self.lock:
            self.message_listeners = (*self.message_listeners, listener)

        def stop() -> None:
            with self.lock:
                self.message_listeners = tuple(
                    other for other in self.message_listeners if other is not listener
                )

        return stop

    def notify_message_listeners(self, node: NodeLike, topic: str, message: Any) -> None:
        """Calls the listeners for a message of ``node``. With the lock held."""
        for listener in self.message_listeners:
            listener(self.now_ns, node, topic, message)

    def next_number(self) -> int:
        """The next of a series of numbers, which order entities by their creation."""
        with self.lock:
            self._last_number += 1
            return self._last_number
