"""Limits the wall clock of one submission as a whole: all its episodes, calls, trainings and tests together.

Each process has limits of its own (``kit.host.sandbox.limits``). This clock adds them up: once its time is used up, or
two episodes have taken too long, nothing more of the submission is run. What was shown before keeps its points.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Final

from kit.host.failure import Failure, FailureKind, StudentCodeError
from kit.host.sandbox.limits import Limits
from kit.run.episode import EndCondition, when

if TYPE_CHECKING:
    from kit.render.drive_playback import DrivePlayback

MAX_TIMEOUTS: Final = 2
"""Episodes that may take too long before no other is run."""
SHORTEST_S: Final = 0.001
"""The shortest time limit that a process is given [s]."""
SHOWN_TESTS: Final = 2
"""Number of the newest tests shown, so that the text fits into 80 characters."""
DRIVE_KIND: Final = ", drive"
"""Ends the part before the first colon of a text that is to be drawn, and not to be read."""
TRAINING: Final = "training "
REPORTS: Final = 50
"""How often the steps of one training are shown, about."""


class SubmissionClock:
    """The wall clock of one submission. It runs from the moment it is made."""

    def __init__(
        self, limit_s: float = math.inf, show_progress: Callable[[str], None] = lambda text: None
    ) -> None:
        """``show_progress``: called with what the time is used for, whenever that changes."""
        self.show_progress = show_progress
        self._limit_s = limit_s
        self._began = time.monotonic()
        self._timeouts = 0

    @property
    def left_s(self) -> float:
        """The rest of the submission's time [s]; 0 when it is used up."""
        return max(0.0, self._limit_s - (time.monotonic() - self._began))

    @property
    def is_used_up(self) -> bool:
        return self.left_s < SHORTEST_S

    @property
    def end_condition(self) -> EndCondition:
        """Ends an episode as soon as the time is used up."""
        return when(lambda: self.is_used_up)

    def check(self) -> None:
        """Raises StudentCodeError if the time is used up."""
        if self.is_used_up:
            raise StudentCodeError(self.used_up_failure())

    def shorten(self, limits: Limits) -> Limits:
        """Returns the limits of a process that starts now: none of its times is longer than what is left."""
        if math.isinf(self._limit_s):
            return limits
        left = max(SHORTEST_S, self.left_s)
        total = left if limits.total_s is None else min(limits.total_s, left)
        return replace(limits, start_s=min(limits.start_s, left), total_s=total)

    def explain(self, failure: Failure) -> Failure:
        """Returns the failure to report: of the whole submission where a process was ended because its time was used up."""
        is_ours = failure.kind is FailureKind.TIMEOUT and self.is_used_up
        return self.used_up_failure() if is_ours else failure

    def used_up_failure(self) -> Failure:
        return Failure(
            FailureKind.TIMEOUT,
            f"the {self._limit_s:g} s that a submission may take are used up. Whatever had not ended by then earns no points.",
        )

    def refusal(self) -> Failure | None:
        """Returns why nothing more of the submission is run; None while it may."""
        if self.is_used_up:
            return self.used_up_failure()
        if self._timeouts >= MAX_TIMEOUTS:
            message = f"it was not run, because {MAX_TIMEOUTS} earlier ones took too long."
            return Failure(FailureKind.TIMEOUT, message)
        return None

    def note(self, failure: Failure | None) -> None:
        """Counts an episode that has taken too long. ``failure``: how an episode failed; None if it did not."""
        self._timeouts += failure is not None and failure.kind is FailureKind.TIMEOUT


class TrainingProgressReport:
    """The progress of one training, shown on the submission's clock: which of how many, its steps, and the success in its
    tests so far."""

    def __init__(self, clock: SubmissionClock, number: int, count: int, steps: int) -> None:
        """``number``: which training of ``count``, from 1. ``steps``: its most steps."""
        self.clock = clock
        self.number = number
        self._title = f"{TRAINING}{number} of {count}"
        self._steps = steps
        self._next = 0
        self._tests: list[float] = []
        self._told_places: set[str] = set()
        """Cases whose place was told with a drive."""

    def show(self, steps: int) -> None:
        """Shows the steps done, where they have grown since the last time by enough to be worth it."""
        if steps >= self._next:
            self._next = steps + max(1, self._steps // REPORTS)
            self.clock.show_progress(f"{self._title}: {steps:,} of {self._steps:,} steps{self._curve}")

    def add_test(self, steps: int, success: float, drive: DrivePlayback | None = None) -> None:
        """Adds the success of a test during the training, 0 to 1, and shows it: in a line of its own, which a lesson draws a
        curve from, and with the tests before it. ``drive``: one of the test's episodes, which a lesson plays again; its place
        is told once."""
        self._tests.append(success)
        if drive is not None:
            text = drive.to_text(with_place=drive.case not in self._told_places)
            self._told_places.add(drive.case)
            if text:
                self.clock.show_progress(f"{self._title}{DRIVE_KIND}: {text}")
        self.clock.show_progress(
            f"{self._title}, test: {100 * success:.0f} % after {steps:,} of {self._steps:,} steps"
        )
        self._next = 0
        self.show(steps)

    def show_exam(self) -> None:
        """Shows that the training is over, and its policy tested."""
        self.clock.show_progress(f"{self._title}: exam{self._curve}")

    def add_exam(self, success: float) -> None:
        """Shows what the exam found, 0 to 1: the figure that is judged, which a lesson shows beside the curve of the tests."""
        self.clock.show_progress(f"{self._title}, exam: {100 * success:.0f} %")

    @property
    def _curve(self) -> str:
        """The newest tests in words, so that it can be read aloud; empty before the first."""
        shown = [f"{100 * each:.0f}" for each in self._tests[-SHOWN_TESTS:]]
        earlier = "... " if len(self._tests) > SHOWN_TESTS else ""
        return f", tests {earlier}{' '.join(shown)} %" if shown else ""
