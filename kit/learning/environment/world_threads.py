"""The step of a batch's worlds, on one thread or several."""

from __future__ import annotations

import os
import time
import weakref
from collections.abc import Callable
from contextlib import suppress
from queue import SimpleQueue
from threading import Thread

import numpy as np

from kit.arrays import IntArray
from kit.kernels import batch_step, compilation
from kit.kernels.arrays import Step, StepScratch

LEAST_SHARED = 512
"""Threads share so many worlds at least: for fewer it takes longer to tell one than it spares."""
PATIENCE = 200_000
"""So often a thread looks whether another one has done its part before the operating system may run others instead: for some
tenths of a millisecond, as long as a caller that just steps takes between two steps."""


class WorldThreads:
    """Makes steps on several threads, a few worlds at a time on each. As no world depends on another one, what they compute is
    the same to the bit."""

    def __init__(self, threads: int) -> None:
        """``threads``: at most so many; the calling thread is one of them, and the only one where the operating system refuses
        others. ValueError below 1."""
        if threads < 1:
            raise ValueError(f"worlds run on at least one thread, not on {threads}")
        self.count = threads
        self._run = compilation.TypedKernel(batch_step.run_step)
        self._begun = np.zeros(batch_step.COUNTS, dtype=np.int64)
        """The number of the last step that has begun."""
        self._jobs: SimpleQueue[StartedStep | None] | None = None
        self._started_by = 0
        """The process whose threads take from ``_jobs``."""

    def start(self, step: Step, scratch: StepScratch) -> StartedStep:
        """Moves all robots. What they scan is there after ``finish``; the calling thread, whose ``scratch`` that is, may do
        something else before."""
        started = StartedStep(
            self._run, step, self._begun, int(self._begun[batch_step.CACHE_LINE]) + 1, scratch
        )
        jobs = self._start_threads() if len(step.outputs.poses) >= LEAST_SHARED else None
        if jobs is not None:
            for _ in range(self.count - 1):
                jobs.put(started)
        started.advance()
        return started

    def _start_threads(self) -> SimpleQueue[StartedStep | None] | None:
        """What the threads beside the calling one take their work from, None where they may not be started; those of a process
        that has forked are gone in its child, which starts its own."""
        if self.count > 1 and self._started_by != os.getpid():
            jobs: SimpleQueue[StartedStep | None] = SimpleQueue()
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


class StartedStep:
    """A step that several threads make: the calling one ``finish``es it, others ``help``."""

    def __init__(
        self,
        run: Callable[..., bool],
        step: Step,
        begun: IntArray,
        number: int,
        scratch: StepScratch,
    ) -> None:
        """``run``, ``begun``, ``number``: see ``batch_step.run_step``. ``scratch``: of the calling thread."""
        self._run, self._step, self._begun, self._number, self._scratch = run, step, begun, number, scratch
        self._is_finished = False

    def advance(self) -> None:
        """Moves the robots that no thread has begun to move, and returns when all have moved."""
        while not self._do(batch_step.ADVANCE, self._scratch):
            time.sleep(0)

    def finish(self) -> None:
        """Makes the scans that no thread has begun, and returns when all have been made."""
        while not (self._is_finished or self._do(batch_step.SCAN, self._scratch)):
            time.sleep(0)
        self._is_finished = True

    def help(self, scratch: StepScratch | None) -> StepScratch:
        """Moves and scans beside the calling thread, unless that has finished, and waits a little for the next step. Takes and
        returns the scratch arrays of the helping thread, None before its first step."""
        if scratch is None:
            scratch = batch_step.allocate_scratch(self._step.rules, self._step.outputs.poses.shape[1])
        if not self._is_finished:
            self._do(batch_step.HELP, scratch)
        return scratch

    def _do(self, part: int, scratch: StepScratch) -> bool:
        """Whether that part is done by all threads."""
        return bool(self._run(scratch, self._step, part, self._begun, self._number, PATIENCE))


def _help_with(jobs: SimpleQueue[StartedStep | None]) -> None:
    scratch: StepScratch | None = None
    while (job := jobs.get()) is not None:
        with suppress(MemoryError):  # then the calling thread does everything
            scratch = job.help(scratch)
        del job  # and its arrays


def _end_threads(jobs: SimpleQueue[StartedStep | None], threads: int) -> None:
    for _ in range(threads):
        jobs.put(None)


def available_threads() -> int:
    """How many threads can run at once on this machine, for this process."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
