"""Runs a world in a thread of its own: in real time, faster or slower, or as fast as it can; paused, stepped.

The face reads views (newest wins) and posts jobs; the physics never waits for it.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Final

from kit.run.pacing import REAL_TIME, PacingStatus, Schedule, SpeedMeter
from kit.run.runner import Runner

STOP_S: Final = 10.0
"""How long to wait for the end of the current tick [s]."""
MAX_BURST_S: Final = 0.02
"""Longest time [s] of ticks in a row before posted jobs are done: keys never wait longer than this."""


class WorldThread:
    """Runs ``runner`` in a worker thread until ``stop``. Use as a context manager.

    ``on_change`` is called in the worker thread after each stretch of ticks and each posted job: at most a
    hundred times a second; it must only note that there is something new. A job that raises ends the run;
    ``failure`` then holds the exception.
    """

    def __init__(
        self, runner: Runner, *, factor: float = REAL_TIME, on_change: Callable[[Runner], None]
    ) -> None:
        self._runner = runner
        self._on_change = on_change
        self._factor = factor
        self._wake = threading.Condition()
        self._jobs: list[Callable[[Runner], object]] = []
        self._steps = 0
        self._stopping = False
        self._has_ticked = False
        self._meter = SpeedMeter()
        self.failure: BaseException | None = None
        self._thread = threading.Thread(target=self._run_guarded, name="world", daemon=True)

    def __enter__(self) -> WorldThread:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()

    @property
    def pacing(self) -> PacingStatus:
        """The speed as it is now."""
        return PacingStatus(self._factor, self._meter.factor, self._runner.paused)

    def post(self, job: Callable[[Runner], object]) -> None:
        """Queues ``job`` for the world's thread, which does it between two ticks, as soon as possible."""
        with self._wake:
            self._jobs.append(job)
            self._wake.notify()

    def set_factor(self, factor: float) -> None:
        """Changes the speed while running."""
        with self._wake:
            self._factor = factor
            self._wake.notify()

    def set_paused(self, paused: bool) -> None:
        """Pauses the run, or lets it go on."""
        self.post(lambda runner: setattr(runner, "paused", paused))

    def step(self, ticks: int = 1) -> None:
        """Makes ``ticks`` ticks while paused."""
        with self._wake:
            self._steps += ticks
            self._wake.notify()

    def stop(self, wait_s: float = STOP_S) -> bool:
        """Ends the run after the current tick and waits for the thread; not for the first tick, which loads the kernels.
        Returns whether it has ended."""
        with self._wake:
            self._stopping = True
            self._wake.notify()
        is_loading = not self._has_ticked and not self._runner.paused
        if self._thread.is_alive() and not is_loading and threading.current_thread() is not self._thread:
            self._thread.join(timeout=wait_s)
        return not self._thread.is_alive()

    def _run_guarded(self) -> None:
        try:
            self._run_loop()
        except BaseException as error:  # noqa: BLE001 - a thread has nobody above it; the face shows this
            self.failure = error
            self._on_change(self._runner)

    def _run_loop(self) -> None:
        runner = self._runner
        schedule = Schedule(runner.simulation.step_size, time.monotonic())
        while True:
            with self._wake:
                if not self._jobs and not self._steps and not self._stopping:
                    self._wake.wait(None if runner.paused else schedule.seconds_until_next(time.monotonic()))
                jobs, self._jobs = self._jobs, []
                steps, self._steps = self._steps, 0
                if self._stopping:
                    return
                schedule.set_factor(self._factor)
            for job in jobs:
                job(runner)
            if runner.paused:
                self._step_paused(steps)
                schedule.restart(time.monotonic())
                self._meter.restart()
            else:
                self._tick_while_due(schedule)
            self._has_ticked = True
            self._on_change(runner)

    def _step_paused(self, steps: int) -> None:
        runner = self._runner
        if steps:
            runner.step_paused(steps)
        runner.tick()  # while paused: services are answered, and allowed steps done
        while runner.paused_steps_left and not self._stopping:
            runner.tick()

    def _tick_while_due(self, schedule: Schedule) -> None:
        runner, step = self._runner, self._runner.simulation.step_size
        end = time.monotonic() + MAX_BURST_S
        ticks = 0
        while not runner.paused and schedule.is_due(now := time.monotonic()):
            runner.tick()
            schedule.count_tick()
            ticks += 1
            if now >= end or self._jobs or self._stopping:
                break
        self._meter.add(ticks * step, time.monotonic())
