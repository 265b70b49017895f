"""Follows a training: its files read in one thread, its newest policy driving in another."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from queue import Empty, SimpleQueue
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from kit.learning.training.demonstration import Demonstration, DemonstrationView
    from kit.learning.training.events import TrainingEvent
    from kit.learning.training.run_status import RunPlan, RunStatus
    from kit.learning.training.runs import TrainingRun
    from kit.learning.training.training_summary import TrainingCommand


POLL_S: Final = 0.5
"""Between two looks at the run's files, which may lie on a slow network drive."""
HOLD_S: Final = 1.0
"""How long the end of an episode stands still, to be read."""


class TrainingFollower:
    """Reads a training's events as they come, and shows how its newest policy drives. It calls its callbacks in threads of its
    own."""

    def __init__(
        self,
        run: TrainingRun,
        *,
        on_status: Callable[[RunStatus], None],
        on_view: Callable[[DemonstrationView], None],
        on_error: Callable[[str], None],
    ) -> None:
        self._run = run
        self._on_status = on_status
        self._on_view = on_view
        self._on_error = on_error
        self._last_error = ""
        self._jobs: SimpleQueue[Callable[[], None] | None] = SimpleQueue()
        self._closed = threading.Event()
        self._skip_requested = threading.Event()
        self._case: str | None = None
        self._has_ended = False
        self._reader = threading.Thread(target=self._read, name="reader", daemon=True)
        self._driver: threading.Thread | None = None

    def start(self) -> None:
        self._reader.start()

    def send_order(self, order: TrainingCommand) -> None:
        """Tells the learner, which obeys between two updates."""
        self._jobs.put(lambda: self._run.send_command(order))

    def resume(self) -> None:
        """Starts a learner that goes on where the last one left off."""

        def job() -> None:
            from kit.learning.training.worker import start_worker

            start_worker(self._run)

        self._jobs.put(job)

    def show_case(self, case: str | None) -> None:
        """Sets the case that is driven from now on; None: all in turn."""
        self._case = case
        self.skip_episode()

    def skip_episode(self) -> None:
        """Goes on to the next episode at once."""
        self._skip_requested.set()

    def close(self) -> None:
        """Ends the looking, not the training."""
        self._closed.set()
        self._skip_requested.set()
        self._jobs.put(None)
        for thread in (self._reader, self._driver):
            if thread is not None and thread.is_alive():
                thread.join(timeout=2)

    # The reader's thread

    def _read(self) -> None:
        from kit.learning.tasks.learning_task import UnknownTask
        from kit.learning.training.algorithms import UnknownAlgorithm
        from kit.learning.training.events import EventReader
        from kit.learning.training.run_config import RunError
        from kit.learning.training.run_status import RunTracker, plan_of_run

        try:
            plan = plan_of_run(self._run.config())
        except (RunError, UnknownTask, UnknownAlgorithm) as error:
            self._on_error(str(error))
            return
        tracker, reader, shown = RunTracker(plan), EventReader(self._run.events_file), None
        while not self._closed.is_set():
            try:
                # Asked first: whatever is written before the end is read below.
                present = self._run.is_active, self._run.read_command()
                new: list[TrainingEvent] = list(reader.read_new())
            except OSError as error:  # a network drive that is away comes back
                self._report_once(f"{self._run.folder}: {error.strerror}. Looking again.")
            else:
                for event in new:
                    tracker.add(event)
                self._has_ended = not present[0]
                if new or present != shown:
                    shown = present
                    self._on_status(tracker.status(alive=present[0], order=present[1]))
                if self._driver is None:
                    self._start_driver(plan)
            self._run_jobs()

    def _run_jobs(self) -> None:
        """Waits up to ``POLL_S`` seconds for a job, and carries it out."""
        from kit.learning.training.run_config import RunError

        try:
            job = self._jobs.get(timeout=POLL_S)
        except Empty:
            return
        if job is not None:
            try:
                job()
            except (RunError, OSError) as error:
                self._on_error(str(error))

    def _report_once(self, trouble: str) -> None:
        """Reports an error, once."""
        if trouble != self._last_error:
            self._last_error = trouble
            self._on_error(trouble)

    def _start_driver(self, plan: RunPlan) -> None:
        self._driver = threading.Thread(target=self._drive, args=(plan,), name="driver", daemon=True)
        self._driver.start()

    # The driver's thread

    def _drive(self, plan: RunPlan) -> None:
        from kit.learning.policies.policy import PolicyError
        from kit.learning.training.demonstration import Demonstration
        from kit.learning.training.run_config import RunError

        demonstration = Demonstration(self._run, greedy=plan.greedy)
        while not self._closed.is_set():
            self._skip_requested.clear()
            demonstration.case = self._case
            wait = POLL_S
            try:
                if demonstration.begin_episode(kept=self._has_ended):
                    self._drive_episode(demonstration)
                    wait = HOLD_S
            except (PolicyError, RunError, OSError) as error:
                self._report_once(str(error))
            self._skip_requested.wait(wait)

    def _drive_episode(self, demonstration: Demonstration) -> None:
        """One episode, as fast as the robot would drive."""
        due = time.monotonic()
        self._on_view(demonstration.view())
        while not demonstration.is_over:
            due = max(due + demonstration.step_time, time.monotonic())
            if self._skip_requested.wait(due - time.monotonic()) or self._closed.is_set():
                return
            demonstration.step()
            self._on_view(demonstration.view())
