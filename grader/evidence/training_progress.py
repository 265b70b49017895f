"""Shows how far a training is: which of how many, its steps, and the success in its tests so far."""

from __future__ import annotations

from typing import Final

from grader.evidence.submission_clock import SubmissionClock

SHOWN_TESTS: Final = 3
"""So many of the newest tests are shown: with them the text fits into a line of 80 characters."""
REPORTS: Final = 50
"""How often the steps of one training are shown, about."""


class TrainingProgressReport:
    """The progress of one training, shown on the submission's clock."""

    def __init__(self, clock: SubmissionClock, number: int, count: int, steps: int) -> None:
        """``number``: which training of ``count``, from 1. ``steps``: its most steps."""
        self.clock = clock
        self.number = number
        self._count = count
        self._steps = steps
        self._next = 0
        self._tests: list[float] = []

    def show(self, steps: int) -> None:
        """Shows the steps done, where they have grown since the last time by enough to be worth it."""
        if steps >= self._next:
            self._next = steps + max(1, self._steps // REPORTS)
            self.clock.show_progress(f"{self._title}: {steps:,} of {self._steps:,} steps{self._curve}")

    def add_test(self, steps: int, success: float) -> None:
        """Adds the success of a test during the training, 0 to 1, and shows it."""
        self._tests.append(success)
        self._next = 0
        self.show(steps)

    def show_exam(self) -> None:
        """Shows that the training is over, and its policy tested."""
        self.clock.show_progress(f"{self._title}: exam{self._curve}")

    @property
    def _title(self) -> str:
        return f"training {self.number} of {self._count}"

    @property
    def _curve(self) -> str:
        """The newest tests in words, so that it can be read aloud; empty before the first."""
        shown = [f"{100 * each:.0f}" for each in self._tests[-SHOWN_TESTS:]]
        earlier = "... " if len(self._tests) > SHOWN_TESTS else ""
        return f", tests {earlier}{' '.join(shown)} %" if shown else ""
