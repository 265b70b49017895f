"""Makes the threads of a program in the child wait for each other in the graph.

All waits that Python's own modules offer end in the acquisition of a lock: ``Condition.wait`` (and so ``Event``,
``Semaphore``, ``Barrier``, ``queue.Queue``, ``concurrent.futures``), ``Lock.acquire``; ``Thread.join`` and
``queue.SimpleQueue`` have locks of their own. Where the program asks for such a wait, it is a wait in the graph: a time-out
is simulated, and a thread that waits for another one is known to wait, so that ticks end with it, in the same order on
every machine. The waits that libraries ask for stay real: what they wait for is not of the world.
"""

from __future__ import annotations

import os
import sys
import threading
from collections.abc import Callable
from contextlib import suppress
from functools import cache, wraps
from types import FrameType
from typing import Any, Final
from weakref import WeakSet

from kit.host.child.import_hooks import on_import
from kit.ros.graph.graph import Graph

WAITING_MODULES: Final = ("threading.py", "queue.py", "sched.py", "concurrent/futures/")
"""The modules of Python that wait for who calls them, relative to its library's folder."""
LOCK_WEIGHT: Final = 0.01
"""How many readings of the clock an acquired lock stands for: locks also guard what is computed."""


class WaitingClock:
    """What the clock shows to those modules, which compute with it how long they still have to wait."""

    def __init__(self, graph: Graph) -> None:
        self._graph = graph
        self._skipped_ns = 0

    def read(self) -> float:
        """The time [s]."""
        return (self._graph.now_ns + self._skipped_ns) / 1e9

    def end_of(self, timeout_s: float) -> int:
        """When a wait ends that begins now [ns, of the graph].

        What is left of a wait by an error of a sum of floats (less than a nanosecond) is over.
        """
        timeout_ns = round(timeout_s * 1e9)
        if timeout_ns == 0 and timeout_s > 0:
            self._skipped_ns += 1
        return self._graph.now_ns + timeout_ns


class SimulatedWaits:
    """Puts waits in the graph in place of those of ``threading`` and ``queue``, for the program's own code.

    ``library``: the folder of Python's modules, ending in a separator. ``is_own_code`` tells whether a file of code belongs
    to the program.
    """

    def __init__(self, graph: Graph, library: str, is_own_code: Callable[[str], bool]) -> None:
        self._graph = graph
        self._is_own_code = is_own_code
        self._ended: WeakSet[threading.Thread] = WeakSet()
        self._start_code = threading.Thread.start.__code__
        self.clock = WaitingClock(graph)
        asking = os.path.join(os.path.dirname(__file__), "simulated_polls.py")  # pathlib takes 3 ms to import
        between = (__file__, asking)  # they stand between the program and those modules
        prefixes = (*between, *(library + name for name in WAITING_MODULES))

        @cache
        def is_waiting_code(file: str) -> bool:
            return file.startswith(prefixes)

        self.is_waiting_code = is_waiting_code

    def is_program(self, depth: int = 2) -> bool:
        """Whether the program asks for a wait: whose code is nearest, beyond the modules that wait for others.

        A thread that has no other code is one of a pool, or a ``Timer``: it waits for the program, unless it is in a pool of
        the kit. ``depth``: how many calls up to begin.
        """
        frame = sys._getframe(depth)
        while self.is_waiting_code(frame.f_code.co_filename):
            if frame.f_code is self._start_code:  # the new thread begins at once
                return False
            if frame.f_back is None:
                thread = threading._active.get(threading.get_ident())  # type: ignore[attr-defined]
                return (
                    thread is not None and thread not in self._graph.pool_threads
                )  # None: it is just starting
            frame = frame.f_back
        return self._is_own_code(frame.f_code.co_filename)

    def count_failure(self) -> None:
        """Counts a question of the program whether a lock is free, as a reading of the clock is counted."""
        if self.is_program(3):
            self._graph.count_read()

    def count_lock(self) -> None:
        """Counts, by ``LOCK_WEIGHT``, that the program itself has acquired and released a lock."""
        frame: FrameType | None = sys._getframe(2)
        while frame is not None and frame.f_code.co_filename in (__file__, threading.__file__):
            frame = frame.f_back
        if frame is not None and self._is_own_code(frame.f_code.co_filename):
            self._graph.count_read(LOCK_WEIGHT)

    def install(self) -> None:
        """Replaces what waits in ``threading`` now, and in ``queue`` when it is imported."""
        self._replace_locks()
        self._replace_join()
        threading._time = self.clock.read  # type: ignore[attr-defined]
        on_import("queue", self._replace_queues)

    def wait_for_threads(self) -> None:
        """Waits until all threads of the program but this one and its daemons have ended, as Python does at its end."""
        for stop in reversed(threading._threading_atexits):  # type: ignore[attr-defined]  # of pools, whose threads wait for work
            stop()
        while others := [
            thread
            for thread in threading.enumerate()
            if thread is not threading.current_thread() and not thread.daemon
        ]:
            self._wait_for_end(others[0], None)

    def _wait_for_end(self, thread: threading.Thread, until_ns: int | None) -> bool:
        return self._graph.wait(lambda: thread in self._ended, until_ns, what="Thread.join()")

    def _replace_locks(self) -> None:
        waits, graph = self, self._graph
        make_real_lock, make_real_rlock = threading.Lock, threading.RLock

        class Lock:
            """A lock for which the program waits in the graph. Others than the program get a real one."""

            __slots__ = ("__weakref__", "_real", "_waiting")
            _real: Any
            _waiting: int

            def __new__(cls) -> Any:
                if not waits.is_program():
                    return make_real_lock()
                lock = super().__new__(cls)
                lock._at_fork_reinit()
                return lock

            def _at_fork_reinit(self) -> None:
                self._real = make_real_lock()
                self._waiting = 0

            def acquire(self, blocking: bool = True, timeout: float = -1) -> bool:
                if self._real.acquire(False):
                    return True
                if not blocking and timeout == -1:
                    waits.count_failure()
                    return False
                if not blocking or (timeout < 0 and timeout != -1) or not waits.is_program():
                    return bool(self._real.acquire(blocking, timeout))
                with graph.lock:
                    self._waiting += 1
                try:
                    until_ns = None if timeout == -1 else waits.clock.end_of(timeout)
                    return graph.wait(
                        lambda: bool(self._real.acquire(False)), until_ns, what="the wait for another thread"
                    )
                finally:
                    with graph.lock:
                        self._waiting -= 1

            def release(self) -> None:
                self._real.release()
                if self._waiting:
                    graph.notify()
                waits.count_lock()  # not before: who lets time pass with a lock held keeps others from ever getting it

            def _is_owned(self) -> bool:
                """What a Condition asks before it waits; without this it would try to acquire the lock, which is counted."""
                return bool(self._real.locked())

            def locked(self) -> bool:
                waits.count_failure()
                return bool(self._real.locked())

            def __enter__(self) -> bool:
                return self.acquire()

            def __exit__(self, *_: object) -> None:
                self.release()

        def make_rlock() -> Any:
            if not waits.is_program():
                return make_real_rlock()
            lock = threading._PyRLock()  # type: ignore[attr-defined]
            lock._block = object.__new__(Lock)  # by itself it would ask who calls, and find this function
            lock._block._at_fork_reinit()
            return lock

        threading.Lock = threading._allocate_lock = Lock  # type: ignore[attr-defined]
        threading.RLock = make_rlock  # type: ignore[assignment]

    def _replace_join(self) -> None:
        waits, graph = self, self._graph
        real_join, forget = threading.Thread.join, threading.Thread._delete  # type: ignore[attr-defined]

        @wraps(real_join)
        def join(thread: threading.Thread, timeout: float | None = None) -> None:
            if thread.is_alive() and thread is not threading.current_thread() and waits.is_program():
                until_ns = None if timeout is None else waits.clock.end_of(max(0.0, timeout))
                if not waits._wait_for_end(thread, until_ns):
                    return
                timeout = None  # it has nothing left to do
            real_join(thread, timeout)

        def forget_and_tell(thread: threading.Thread) -> None:
            with graph.lock:  # a waiter sees both or none
                forget(thread)
                waits._ended.add(thread)
                graph.notify()

        threading.Thread.join = join  # type: ignore[assignment, method-assign]
        threading.Thread._delete = forget_and_tell  # type: ignore[attr-defined]

    def _replace_queues(self, module: Any) -> None:
        waits, graph = self, self._graph
        module.time = self.clock.read

        class SimpleQueue(module.SimpleQueue):  # type: ignore[misc]
            """A queue for whose items the program waits in the graph."""

            def put(self, item: object, block: bool = True, timeout: float | None = None) -> None:
                super().put(item, block, timeout)
                graph.notify()

            def put_nowait(self, item: object) -> None:
                self.put(item)

            def get(self, block: bool = True, timeout: float | None = None) -> Any:
                try:
                    return super().get(False)
                except module.Empty:
                    if not block or (timeout is not None and timeout < 0) or not waits.is_program():
                        return super().get(block, timeout)
                found: list[Any] = []
                take = super().get

                def is_there() -> bool:
                    with suppress(module.Empty):
                        found.append(take(False))
                    return bool(found)

                until_ns = None if timeout is None else waits.clock.end_of(timeout)
                if not graph.wait(is_there, until_ns, what="SimpleQueue.get()"):
                    raise module.Empty
                return found[0]

        module.SimpleQueue = SimpleQueue
