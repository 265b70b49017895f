"""How far a lesson, an exercise or a work is, as marks that are also read where there is no colour."""

from __future__ import annotations

from typing import Final

from kit.school.lessons.catalogue import LessonEntry, LessonProgress
from kit.school.lessons.records import LessonStep

STEP_DONE: Final = "■"
STARS: Final = 3
"""Stars of an exercise that has all points."""
BAR_WIDTH: Final = 20
"""Characters of a bar that is full."""


def mark(entry: LessonEntry) -> str:
    """Done, begun, or neither; also where there is no colour."""
    if entry.progress is None:
        return "[!]"
    return "[x]" if entry.is_completed else "[~]" if entry.has_started else "[ ]"


def progress_bar(progress: LessonProgress, here: LessonStep | None = None) -> str:
    """One character a step: a full square where it is done, an empty one where one stands, else a dot."""
    return "".join(
        STEP_DONE
        if progress.is_step_completed(step)
        else "□"
        if here is not None and step.number == here.number
        else "·"
        for step in progress.lesson.steps
    )


def stars(progress: LessonProgress, exercise: str) -> str:
    """``***`` for everything, ``**.`` from half of the points on, ``*..`` for some, ``...`` for none yet; one more for a
    program that was defended."""
    share = progress.best_shares.get(exercise, 0.0)
    count = STARS if exercise in progress.passed_exercises else 2 if share >= 0.5 else 1 if share > 0 else 0
    return "*" * count + "." * (STARS - count) + "*" * (exercise in progress.defended_exercises)


def share_bar(share: float) -> str:
    """How far something is: ``share`` from 0 to 1, one character for a twentieth."""
    full = round(min(max(share, 0.0), 1.0) * BAR_WIDTH)
    return "█" * full + "░" * (BAR_WIDTH - full)
