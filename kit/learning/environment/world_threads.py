"""The compiled loops over a batch's worlds: some of them in one go, on one thread or several."""

from __future__ import annotations

import os
import weakref
from collections.abc import Callable, Sequence
from heapq import heappop, heappush
from queue import SimpleQueue
from threading import Lock, Thread
from typing import Any, NamedTuple, TypeAlias, TypeVar

from kit.kernels.compilation import compiled_for

Kernel: TypeAlias = Callable[..., None]
T = TypeVar("T")

LEAST_SHARED = 1024
"""Threads share so many worlds at least: for fewer it takes longer to wake one than it spares."""
LEAST_CHUNK = 256
"""A thread takes so many worlds at a time at least."""


class LoopCall(NamedTuple):
    """One call of a ``WorldLoop``, to be made."""

    loop: WorldLoop
    arguments: tuple[Any, ...]

    def run(self, worlds: slice | None = None) -> None:
        """Makes the call, for some of the worlds or for all."""
        loop, arguments = self
        if worlds is not None:
            arguments = tuple(
                argument if place in loop.shared else argument[worlds]
                for place, argument in enumerate(arguments)
            )
        if loop.code is None:
            loop.code = compiled_for(loop.kernel, arguments)
        loop.code(*arguments)


class WorldLoop:
    """A kernel that takes arrays of n worlds and treats each world by itself. ``shared``: the places of those arguments that
    are the same for all worlds. Between calls the types, dimensions and layout of arguments stay the same."""

    def __init__(self, kernel: Kernel, shared: Sequence[int]) -> None:
        self.kernel = kernel
        self.shared = frozenset(shared)
        self.code: Kernel | None = None
        """For the types of the first call's arguments."""

    def with_arguments(self, *arguments: Any) -> LoopCall:
        """A call with these arguments, which are contiguous arrays."""
        return LoopCall(self, arguments)


class StartedCalls:
    """Calls that several threads make, chunk by chunk of worlds: ``first`` ones, and ``later`` ones that need those of their own
    worlds alone."""

    def __init__(
        self,
        first: Sequence[LoopCall],
        later: Sequence[LoopCall],
        chunks: Sequence[slice | None],
        others: int = 0,
    ) -> None:
        """``chunks``: the largest first, or None for all worlds at once. ``others``: how many threads beside the calling one
        may ``help``."""
        self._first, self._later = first, later
        self._chunks = chunks
        self._numbers = iter(range(len(chunks)))
        """The chunks whose first calls have not begun: each thread takes the next one."""
        self._unmade = iter(range(len(chunks) - 1, -1, -1))
        """How many chunks' first calls are not made, counted down as they are."""
        self._are_first_made = Lock()
        """Held until they are."""
        self._are_first_made.acquire()
        self._ready: list[int] = []
        """A heap of the chunks whose first calls have been made and whose later ones have not begun."""
        self._places = [True] * others
        """One for each thread that may still begin to help."""
        self._others = others
        self._ended: SimpleQueue[BaseException | None] = SimpleQueue()
        """What each thread that has helped ended with."""

    def make_first(self) -> None:
        """Makes the first calls that no thread has begun, and returns when all have been made."""
        self._run_first()
        self._are_first_made.acquire()
        self._are_first_made.release()

    def finish(self) -> None:
        """Makes the calls that no thread has begun, and returns when all have been made."""
        try:
            self.make_first()
            self._run_later()
        finally:
            while _take(self._places):  # who has not begun has nothing left to do
                self._others -= 1
            errors = [self._ended.get() for _ in range(self._others)]
            self._others = 0
        for error in filter(None, errors):
            raise error

    def help(self) -> None:
        """Makes calls beside the calling thread, unless that has finished."""
        if not _take(self._places):
            return
        error: BaseException | None = None
        try:
            self._run_first()
            self._run_later()
        except BaseException as raised:  # noqa: BLE001  # raised again where the calls are finished
            error = raised
        self._ended.put(error)

    def _run_first(self) -> None:
        for number in self._numbers:
            try:
                for call in self._first:
                    call.run(self._chunks[number])
            finally:
                heappush(self._ready, number)
                if not next(self._unmade):
                    self._are_first_made.release()

    def _run_later(self) -> None:
        while self._later and (number := _take(self._ready, heappop)) is not None:
            for call in self._later:
                call.run(self._chunks[number])


def _take(from_list: list[T], pop: Callable[[list[T]], T] = list.pop) -> T | None:
    """Takes something from a list that several threads take from; None if nothing is left."""
    try:
        return pop(from_list)
    except IndexError:
        return None


class WorldThreads:
    """Runs loops over worlds on several threads, chunks of worlds on each. As no world depends on another one, what they
    compute is the same to the bit."""

    def __init__(self, threads: int) -> None:
        """``threads``: at most so many; the calling thread is one of them, and the only one where the operating system refuses
        others. ValueError below 1."""
        if threads < 1:
            raise ValueError(f"worlds run on at least one thread, not on {threads}")
        self.count = threads
        self._jobs: SimpleQueue[StartedCalls | None] | None = None
        self._started_by = 0
        """The process whose threads take from ``_jobs``."""

    def start(self, n: int, first: Sequence[LoopCall], later: Sequence[LoopCall] = ()) -> StartedCalls:
        """Begins the calls for ``n`` worlds, one after the other for each world. What the ``first`` ones fill is there after
        ``make_first``, all after ``finish``; the calling thread may do something else before."""
        jobs = self._start_threads() if n >= LEAST_SHARED else None
        if jobs is None:
            return StartedCalls(first, later, [None])
        chunks, begin = [], 0
        while begin < n:  # smaller and smaller, so that all threads end together
            end = begin + max((n - begin) // self.count, LEAST_CHUNK)
            chunks.append(slice(begin, end))
            begin = end
        started = StartedCalls(first, later, chunks, self.count - 1)
        for _ in range(self.count - 1):
            jobs.put(started)
        return started

    def _start_threads(self) -> SimpleQueue[StartedCalls | None] | None:
        """What the threads beside the calling one take their work from, None where they may not be started; those of a process
        that has forked are gone in its child, which starts its own."""
        if self.count > 1 and self._started_by != os.getpid():
            jobs: SimpleQueue[StartedCalls | None] = SimpleQueue()
            try:
                for _ in range(self.count - 1):
                    Thread(target=_help_with, args=(jobs,), name="worlds", daemon=True).start()
            except RuntimeError:  # as in a sandbox
                _end_threads(jobs, self.count - 1)
                self.count = 1
                return None
            self._jobs, self._started_by = jobs, os.getpid()
            weakref.finalize(self, _end_threads, jobs, self.count - 1)
        return self._jobs


def _help_with(jobs: SimpleQueue[StartedCalls | None]) -> None:
    while (job := jobs.get()) is not None:
        job.help()
        del job  # and its arrays


def _end_threads(jobs: SimpleQueue[StartedCalls | None], threads: int) -> None:
    for _ in range(threads):
        jobs.put(None)


def available_threads() -> int:
    """How many threads can run at once on this machine, for this process."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
