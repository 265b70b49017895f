"""An exercise on the bench: its file watched, a check under way at most, and what came of it. No Textual."""

from __future__ import annotations

import threading
from pathlib import Path

from kit.host.reload import FileWatch
from kit.school.lessons.checking import Check, Report, handed_in
from kit.school.lessons.records import Exercise
from kit.school.lessons.visit import Visit

BY_HAND = ".npz"
"""What a drive by hand is handed in as."""


class Workbench:
    """One exercise of a visit. ``look`` at it a few times a second; ``close`` it when done.

    Raises WorkError where the student's files cannot be laid out.
    """

    def __init__(self, visit: Visit, exercise: Exercise) -> None:
        self.exercise = exercise
        self._visit = visit
        self.file: Path = visit.lay_out(exercise)
        """What the student edits."""
        self._watch = FileWatch(handed_in(self.exercise, self.file))
        self._check: Check | None = None

    @property
    def by_hand(self) -> bool:
        """Whether what is handed in is driven, not written."""
        return self.exercise.file.endswith(BY_HAND)

    @property
    def seconds(self) -> float | None:
        """How long the check has been running; None while none is."""
        return None if self._check is None else self._check.seconds

    @property
    def report(self) -> Report | None:
        """The newest check's."""
        return self._visit.report(self.exercise)

    def start(self) -> None:
        """Starts a check, unless one is running."""
        if self._check is None:
            self._watch = FileWatch(
                handed_in(self.exercise, self.file)
            )  # what is checked now need not be checked once more
            self._check = self._visit.check(self.exercise)

    def look(self) -> bool:
        """Starts a check where the file was saved, and takes in one that has ended; says whether one has.

        Raises ProgressError where the disk refuses to note it: the report is there all the same.
        """
        if self._check is None:
            if self._watch.has_changed():
                self.start()
            return False
        report = self._check.poll()
        if report is None:
            return False
        self.close()
        self._visit.take(self.exercise, report)
        return True

    def begin_again(self) -> Path | None:
        """The exercise as at first; where the former files were kept. Raises WorkError."""
        self.close()
        kept = self._visit.begin_again(self.exercise)
        self._watch = FileWatch(handed_in(self.exercise, self.file))
        return kept

    def close(self) -> None:
        """Ends the check; nothing is noted of one that has not ended."""
        if self._check is not None:
            # It may take a moment to end what it has started. The interpreter waits for this thread.
            threading.Thread(target=self._check.close, name="end of a check").start()
            self._check = None
