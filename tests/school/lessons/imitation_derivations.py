"""What the lesson on imitation says is found out again, in its own corridor with its own references."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path
from types import ModuleType
from typing import Final

from kit.school.lessons.records import LessonStep
from tests.kit_content import lesson_reference

GUSTS: Final = [0, 1, 0, 0, 0] * 4
"""The wind of each step: a gust every five steps, four times."""
CALM_DAY: Final = [0] * 8
ORDINALS: Final = ("first", "second", "third", "fourth")


def reference() -> ModuleType:
    return lesson_reference("26-imitation", "dagger")


def calm_examples() -> list[list[int]]:
    """Those of a drive along the middle."""
    return [[row, after - row] for row, after in pairwise(CALM_DAY)]


def corridor_wall(words: str, step: LessonStep, folder: Path) -> str:
    return f"the wall is { {4: 'four'}[reference().WALL] } rows away"


def copy_in_gusts(words: str, step: LessonStep, folder: Path) -> str:
    rows = reference().drive(calm_examples(), 0, GUSTS)
    assert rows[-1] == reference().WALL
    gusts = sum(GUSTS[: len(rows) - 1])
    if words.startswith("At"):
        return f"At the {ORDINALS[gusts - 1]} gust"
    return "Further up with each gust, and into the wall."


def rows_of_the_copy(words: str, step: LessonStep, folder: Path) -> str:
    rows = reference().drive(calm_examples(), 0, GUSTS)
    *first, last = sorted({row for row in rows if row < reference().WALL})
    return f"comes to the rows {', '.join(map(str, first))} and {last}"


def after_asking(words: str, step: LessonStep, folder: Path) -> str:
    """The second copy in the same gusts."""
    found = reference()
    known = found.dagger(calm_examples(), 0, GUSTS, found.TEACHER, 1)
    rows = found.drive(known, 0, GUSTS)
    assert max(rows) == 1
    assert all(after == 0 for row, after in pairwise(rows) if row == 1)
    if words.startswith("In row"):
        return "In row 1 it now knows what to do, so it never gets to row 2."
    return "To the first row, and back in the next step."


IMITATION_DERIVATIONS: Final = (corridor_wall, copy_in_gusts, rows_of_the_copy, after_asking)
