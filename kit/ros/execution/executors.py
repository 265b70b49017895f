"""Executors: they run the callbacks of nodes in the thread that spins, or in a pool of threads."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from types import TracebackType
from typing import TYPE_CHECKING, Any, Final, Protocol, Self

from kit.ros.exceptions import (
    ConditionReachedException,
    ExternalShutdownException,
    ShutdownException,
    TimeoutException,
    WouldDeadlock,
)
from kit.ros.execution.callback_groups import ReadyItem, TakenWork
from kit.ros.execution.context import Context, get_default_context
from kit.ros.execution.task import Future, Task
from kit.ros.graph.ready_queue import ReadyQueue
from kit.ros.node.time import S_TO_NS

if TYPE_CHECKING:
    from concurrent.futures import Future as Job


__all__ = [
    "ConditionReachedException",
    "Executor",
    "ExternalShutdownException",
    "MultiThreadedExecutor",
    "ShutdownException",
    "SingleThreadedExecutor",
    "TimeoutException",
]


DEFAULT_THREADS: Final = 8
"""The threads of a MultiThreadedExecutor that is told no number: those of a common computer, not of this one. How many
callbacks can wait for others at one time, and so whether a program deadlocks, is the same on every machine."""


TURN_PAUSE_S: Final = 0.01
MAX_TURN_PAUSES: Final = 50
"""How long the next callback waits for the one before, which neither ends nor waits in the graph: by pauses of this length [s]."""


class SpinnableHandle(Protocol):
    """The part of a NodeHandle that executors use."""

    def set_executor(self, executor: Executor | None) -> None: ...


class SpinnableNode(Protocol):
    """The part of a Node that executors use."""

    @property
    def context(self) -> Context: ...

    @property
    def executor(self) -> Executor | None: ...

    @property
    def handle(self) -> SpinnableHandle: ...


class Executor:
    """Runs callbacks of the nodes added to it, one at a time, in the thread that spins it.

    Time-outs are seconds of the graph's time. Also a context manager, which shuts it down.
    """

    is_exclusive = True
    """Whether callbacks run one at a time, so that a callback that waits for another one never returns."""

    def __init__(self, *, context: Context | None = None) -> None:
        self._context = context or get_default_context()
        self._graph = self._context.graph
        self.ready_queue = ReadyQueue(self._graph, Task, is_exclusive=self.is_exclusive)
        """The ready callbacks and timers of its nodes."""
        self._nodes: list[SpinnableNode] = []
        self._is_shutdown = False
        self._is_woken = False
        self._spinning_thread: int | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, problem: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.shutdown()

    @property
    def context(self) -> Context:
        return self._context

    @property
    def is_spinning(self) -> bool:
        """True if a thread is in one of its spin methods."""
        return self._spinning_thread is not None

    # Nodes

    def add_node(self, node: SpinnableNode) -> bool:
        """Adds a node, and removes it from its previous executor. False if it has been added already."""
        with self._graph.lock:
            if node in self._nodes:
                return False
            if node.context.graph is not self._graph:
                raise RuntimeError(f"{node} belongs to another graph than this executor")
            current = node.executor
            if current is not None:
                current.remove_node(node)
            self._nodes.append(node)
            node.handle.set_executor(self)
            return True

    def remove_node(self, node: SpinnableNode) -> None:
        """Removes a node; no-op if the executor does not have it."""
        with self._graph.lock:
            if node in self._nodes:
                self._nodes.remove(node)
                node.handle.set_executor(None)

    def get_nodes(self) -> list[SpinnableNode]:
        return list(self._nodes)

    # Tasks

    def create_task(self, callback: Callable[..., Any], *args: Any, **kwargs: Any) -> Task[Any]:
        """Schedules a function or coroutine in this executor; the task is its future result."""
        task: Task[Any] = Task(callback, args, kwargs, executor=self)
        self.ready_queue.put(task)
        return task

    def create_future(self) -> Future[Any]:
        """A future whose done callbacks this executor runs."""
        return Future(executor=self)

    def wake(self) -> None:
        """Wakes a waiting spin method so that it re-checks its condition."""
        self._is_woken = True
        self._graph.notify()

    def shutdown(self, timeout_sec: float | None = None) -> bool:
        """Stops spinning and removes the nodes. Returns True: no callback is running in another thread."""
        self._is_shutdown = True
        self._graph.notify()
        for node in self.get_nodes():
            self.remove_node(node)
        return True

    # Spinning

    def spin(self) -> None:
        """Runs callbacks until the executor or the context is shut down. Raises what a callback raises.

        Raises ExternalShutdownException if something other than the program shuts the context down.
        """
        if type(self).spin_once is not Executor.spin_once:  # an executor of the program's own
            while self._context.ok() and not self._is_shutdown:
                self.spin_once()
        else:
            with _Spinning(self):
                while self._context.ok() and not self._is_shutdown:
                    self._run_one(None)
        if self._context.ended_from_outside:
            raise ExternalShutdownException

    def spin_once(self, timeout_sec: float | None = None) -> None:
        """Waits for one callback and runs it. Time-out None or negative: waits without limit; 0: does not wait."""
        with _Spinning(self):
            self._run_one(self._deadline(timeout_sec))

    def spin_until_future_complete(self, future: Future[Any], timeout_sec: float | None = None) -> None:
        """Runs callbacks until the future is done or the time-out is reached."""
        future.call_when_done(self.wake)
        with _Spinning(self):
            deadline = self._deadline(timeout_sec)
            while self._context.ok() and not future.done() and not self._is_shutdown:
                if not self._run_one(deadline, future.done) and not future.done():
                    return

    def spin_once_until_future_complete(self, future: Future[Any], timeout_sec: float | None = None) -> None:
        """Runs at most one callback, unless the future is done first."""
        future.call_when_done(self.wake)
        with _Spinning(self):
            self._run_one(self._deadline(timeout_sec), future.done)

    def wait_for_ready_callbacks(
        self,
        timeout_sec: float | None = None,
        nodes: Sequence[SpinnableNode] | None = None,
        condition: Callable[[], bool] = lambda: False,
    ) -> tuple[Task[Any], ReadyItem, Any]:
        """Waits for one callback; returns a task that runs it when it is called, its entity and its node.

        For an executor of the program's own, whose ``spin_once`` decides in which thread the task is called; it must
        be called. Raises TimeoutException, ShutdownException, ConditionReachedException.
        """
        self.ready_queue.is_exclusive = False
        with _Spinning(self):
            work = self._wait_for_work(self._deadline(timeout_sec), condition)
        if isinstance(work, tuple):
            item, _ = work
            handle: Any = item.handle
            return self._make_task(work), item, None if handle is None else handle.node
        if condition():
            raise ConditionReachedException
        raise TimeoutException if not work else ShutdownException

    def _make_task(self, work: TakenWork) -> Task[Any]:
        graph = self._graph
        with graph.lock:
            graph.running_pool_callbacks += 1

        def run() -> None:
            outer, graph.thread_state.is_pooled = graph.thread_state.is_pooled, True
            try:
                self.ready_queue.execute(work)
            finally:
                graph.thread_state.is_pooled = outer
                with graph.lock:
                    graph.running_pool_callbacks -= 1
                self.wake()

        return Task(run, executor=self)

    def _deadline(self, timeout_sec: float | None) -> int | None:
        if timeout_sec is None or timeout_sec < 0:
            return None
        return self._graph.now_ns + int(timeout_sec * S_TO_NS)

    def _run_one(self, deadline: int | None, is_done: Callable[[], bool] = lambda: False) -> bool:
        """Waits for one callback and runs it. False if none was ready until the deadline [ns].

        Also returns True when ``is_done()`` or after a shutdown; the caller checks which.
        """
        work = self._wait_for_work(deadline, is_done)
        if isinstance(work, tuple):
            self._dispatch(work)
            return True
        return work

    def _wait_for_work(self, deadline: int | None, is_done: Callable[[], bool]) -> TakenWork | bool:
        """Waits for one callback and takes it. False if none was ready until the deadline [ns].

        Returns True when ``is_done()`` or after a shutdown.

        Invariants of the loop:

        * Work comes first: neither deadline nor ``is_done`` is checked while the ready queue has something to run. So
          a spin with a time-out of 0 runs what is ready.
        * ``until`` is the earlier of the deadline and the next timer. A wait that ends at the timer's time goes
          round the loop and takes the timer; only one that ends at the deadline returns False. If both are the
          same time, the timer is ready by then, and ``wait`` returns True.
        * ``is_changed`` is true as soon as anything happens that the code after ``wait`` or the next round reacts
          to: new work, a timer that was added, reset or cancelled (``next_due_ns`` differs from what ``until`` was
          computed from), ``is_done``, ``wake()``, a shutdown of executor or context.
        * ``_is_woken`` is reset only here, after ``wait``: a ``wake()`` before the wait ends it at once.
        """
        graph, ready_queue, context = self._graph, self.ready_queue, self._context
        while True:
            work = self._take_next()
            if work is not None:
                return work
            next_due = ready_queue.next_due_ns
            until = min((time_ns for time_ns in (deadline, next_due) if time_ns is not None), default=None)

            def is_changed(expected: int | None = next_due) -> bool:
                return (
                    self._has_work()
                    or ready_queue.next_due_ns != expected
                    or is_done()
                    or self._is_woken
                    or self._is_shutdown
                    or not context.ok()
                )

            was_changed = graph.wait(is_changed, until, what="spinning", settles=until != next_due)
            self._is_woken = False
            if not context.ok() and context.ended_from_outside:
                raise ExternalShutdownException
            if not context.ok() or self._is_shutdown or is_done():
                return True
            if not was_changed and deadline is not None and until == deadline:
                return False

    def _has_work(self) -> bool:
        return self.ready_queue.has_due_work

    def _take_next(self) -> TakenWork | None:
        return self.ready_queue.take_next()

    def _dispatch(self, work: TakenWork) -> None:
        self.ready_queue.execute(work)


class _Spinning:
    """Context manager that marks an executor as spun by this thread; raises if it is spinning already."""

    def __init__(self, executor: Executor) -> None:
        self._executor = executor

    def __enter__(self) -> None:
        executor = self._executor
        with executor._graph.lock:
            if executor._spinning_thread is None:
                executor._spinning_thread = threading.get_ident()
                return
        work = executor._graph.thread_state.work
        if work is not None and work[0] is executor.ready_queue:
            raise WouldDeadlock(
                "Executor is already spinning: this is one of its callbacks. A callback must not spin its own "
                "executor; return, and go on in a later callback: add_done_callback, await, or a timer."
            )
        raise RuntimeError("Executor is already spinning")

    def __exit__(self, *_: object) -> None:
        self._executor._spinning_thread = None


class SingleThreadedExecutor(Executor):
    """Runs one callback at a time, in the thread that spins."""


class MultiThreadedExecutor(Executor):
    """Callbacks in a pool of threads, as far as their callback groups let them overlap.

    ``num_threads``: how many; by default DEFAULT_THREADS.
    """

    is_exclusive = False

    def __init__(self, num_threads: int | None = None, *, context: Context | None = None) -> None:
        from concurrent.futures import ThreadPoolExecutor  # imported here, since few programs need it

        super().__init__(context=context)
        count = DEFAULT_THREADS if num_threads is None else num_threads
        self._pool = ThreadPoolExecutor(count, thread_name_prefix="ros-callback")
        self._thread_count = count
        self._open_jobs = 0
        """Those that run, and those that wait for a thread of the pool."""
        self._exceptions: list[BaseException] = []
        self._jobs: set[Job[None]] = set()

    def shutdown(self, timeout_sec: float | None = None) -> bool:
        """Stops spinning, removes the nodes, and waits for running callbacks. False if some still run at the time-out."""
        super().shutdown(timeout_sec)
        self._pool.shutdown(wait=False, cancel_futures=True)
        if threading.current_thread().name.startswith("ros-callback"):
            return not self._jobs
        until = None if timeout_sec is None or timeout_sec < 0 else timeout_sec
        for job in list(self._jobs):
            try:
                job.exception(until)
            except TimeoutError:
                return False
        return True

    def _has_work(self) -> bool:
        return bool(self._exceptions) or super()._has_work()

    def _take_next(self) -> TakenWork | None:
        if self._exceptions:
            raise self._exceptions.pop(0)
        return super()._take_next()

    def _dispatch(self, work: TakenWork) -> None:
        with self._graph.lock:
            self._open_jobs += 1
            # Others cannot run before a thread is free: nobody is to wait for them while all threads wait.
            if self._open_jobs <= self._thread_count:
                self._graph.running_pool_callbacks += 1
        threads: list[int] = []
        job = self._pool.submit(self._execute, work, threads)
        self._jobs.add(job)
        job.add_done_callback(self._done)
        if self._graph.waiter is not None:
            self._let_begin(job, threads)

    def _let_begin(self, job: Job[None], threads: Sequence[int]) -> None:
        """Waits until the callback has ended or waits in the graph: so those of one instant begin in their order, on every
        machine. One that does neither, but waits for something outside, delays the others for a while only."""
        graph = self._graph
        with graph.lock:
            for _ in range(MAX_TURN_PAUSES):
                if job.done() or any(each in graph.waiting_threads for each in threads):
                    return
                if self._open_jobs > self._thread_count:  # it waits for a thread of the pool
                    return
                graph.wait_started.wait(TURN_PAUSE_S)

    def _execute(self, work: TakenWork, threads: list[int]) -> None:
        threads.append(threading.get_ident())
        self._graph.pool_threads.add(threading.current_thread())
        self._graph.thread_state.is_pooled = True
        self.ready_queue.execute(work)

    def _done(self, job: Job[None]) -> None:
        self._jobs.discard(job)
        if not job.cancelled():
            exception = job.exception()
            if exception is not None:
                self._exceptions.append(exception)
        with self._graph.lock:  # at once: a waiter that finds no callback running must find the change
            if self._open_jobs <= self._thread_count:
                self._graph.running_pool_callbacks -= 1
            self._open_jobs -= 1
            self._graph.wait_started.notify_all()
            self.wake()
