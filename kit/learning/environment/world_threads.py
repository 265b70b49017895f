"""The compiled loops over a batch's worlds: some of them in one go, on one thread or several."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from itertools import pairwise
from threading import Event
from typing import Any, NamedTuple, TypeAlias

from kit.kernels.compilation import compiled_for

Kernel: TypeAlias = Callable[..., None]

WORLDS_PER_THREAD = 512
"""A thread is woken for so many worlds at least: for fewer that takes longer than their loops."""


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


class WorldThreads:
    """Runs loops over worlds on several threads, slices of worlds on each. As no world depends on another one, what they
    compute is the same to the bit."""

    def __init__(self, threads: int) -> None:
        """``threads``: at most so many; the calling thread is one of them, and the only one where the operating system refuses
        others. ValueError below 1."""
        if threads < 1:
            raise ValueError(f"worlds run on at least one thread, not on {threads}")
        self.count = threads
        self._pool: ThreadPoolExecutor | None = None

    def run(self, n: int, calls: Sequence[LoopCall]) -> None:
        """Makes the calls for ``n`` worlds, one after the other for each world."""
        parts = min(self.count, n // WORLDS_PER_THREAD)
        pool = self._get_pool() if parts > 1 else None
        if pool is None:
            for call in calls:
                call.run()
            return
        ends = [n * part // parts for part in range(parts + 1)]
        slices = [slice(first, end) for first, end in pairwise(ends)]
        others = [pool.submit(partial(_run_calls, calls, worlds)) for worlds in slices[1:]]
        try:
            _run_calls(calls, slices[0])
        finally:
            for other in others:
                other.result()

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


def _run_calls(calls: Sequence[LoopCall], worlds: slice) -> None:
    for call in calls:
        call.run(worlds)


def available_threads() -> int:
    """How many threads can run at once on this machine, for this process."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
