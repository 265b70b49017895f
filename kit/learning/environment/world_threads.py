"""The compiled loops over a batch's worlds: some of them in one go, on one thread or several."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from threading import Event
from typing import Any, NamedTuple, TypeAlias

from kit.kernels.compilation import compiled_for

Kernel: TypeAlias = Callable[..., None]

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
    """Calls that several threads make, chunk by chunk of worlds."""

    def __init__(self, calls: Sequence[LoopCall], chunks: Sequence[slice | None]) -> None:
        self._calls = calls
        self._chunks = iter(chunks)
        """Those not begun: each thread takes the next one."""
        self.others: list[Future[None]] = []
        """What threads beside the calling one do: ``run``."""

    def run(self) -> None:
        """Makes the calls that no thread has begun."""
        for worlds in self._chunks:
            for call in self._calls:
                call.run(worlds)

    def finish(self) -> None:
        """Makes the calls that no thread has begun, and returns when all have been made."""
        try:
            self.run()
        finally:
            for other in self.others:
                if not other.cancel():  # one that has not woken yet has nothing left to do
                    other.result()
            self.others.clear()


class WorldThreads:
    """Runs loops over worlds on several threads, chunks of worlds on each. As no world depends on another one, what they
    compute is the same to the bit."""

    def __init__(self, threads: int) -> None:
        """``threads``: at most so many; the calling thread is one of them, and the only one where the operating system refuses
        others. ValueError below 1."""
        if threads < 1:
            raise ValueError(f"worlds run on at least one thread, not on {threads}")
        self.count = threads
        self._pool: ThreadPoolExecutor | None = None

    def start(self, n: int, calls: Sequence[LoopCall]) -> StartedCalls:
        """Begins the calls for ``n`` worlds, one after the other for each world. What they fill is there after ``finish``; the
        calling thread may do something else before."""
        pool = self._get_pool() if n >= LEAST_SHARED else None
        if pool is None:
            return StartedCalls(calls, [None])
        chunks, first = [], 0
        while first < n:  # smaller and smaller, so that all threads end together
            end = first + max((n - first) // self.count, LEAST_CHUNK)
            chunks.append(slice(first, end))
            first = end
        started = StartedCalls(calls, chunks)
        started.others += [pool.submit(started.run) for _ in range(self.count - 1)]
        return started

    def _get_pool(self) -> ThreadPoolExecutor | None:
        """The threads beside the calling one, None where they may not be started; those of a process that has forked are gone
        in its child."""
        if self._pool is None and self.count > 1:
            pool, all_started = ThreadPoolExecutor(self.count - 1, thread_name_prefix="worlds"), Event()
            try:
                for _ in range(self.count - 1):  # none is idle meanwhile, so each starts a thread
                    pool.submit(all_started.wait)
                self._pool = pool
            except RuntimeError:  # as in a sandbox: a call that it had taken would never be made
                pool.shutdown(wait=False, cancel_futures=True)
                self.count = 1
            finally:
                all_started.set()
        return self._pool


def available_threads() -> int:
    """How many threads can run at once on this machine, for this process."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
