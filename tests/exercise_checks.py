"""Checks an exercise as a lesson does, and waits for the report."""

from __future__ import annotations

from pathlib import Path

from kit.school.lessons.checking import CheckReport, ExerciseCheck
from kit.school.lessons.records import Exercise


def check_exercise(exercise: Exercise, file: Path, *, recording: Path | None = None) -> CheckReport:
    """The report on a file, or on a folder that holds it."""
    with ExerciseCheck(exercise, file, recording=recording) as running:
        return running.wait()
