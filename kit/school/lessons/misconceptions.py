"""The misconceptions that the wrong works beside the solutions stand for, exercise by exercise.

A wrong work is called ``CRITERIA__why``: the criteria that it must lose, joined by ``+``, and what somebody believed who
wrote it. One that was written for a sentence of its lesson quotes it, in a comment that begins with ``Lesson:``.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Final, NamedTuple

from kit.school.lessons.reading import lesson_names, lessons_folder, read_lesson, solutions_folder
from kit.school.lessons.records import Lesson

QUOTE: Final = "# Lesson: "
NO_TEXT: Final = (".npz", ".png", ".dat")
EDITS: Final = ".diff"
ADDED: Final = "+"
"""Ending of a wrong work that is written as edits of its solution, and what a line that it adds begins with."""
WRONG_FOLDER: Final = "wrong"


class Misconception(NamedTuple):
    """One wrong work."""

    lesson: str
    exercise: str
    criteria: tuple[str, ...]
    """What it must lose."""
    why: str
    """In words."""
    sentence: str
    """The lesson's sentence that it misses; empty where none is quoted."""


def misconceptions(lessons: Sequence[Lesson] | None = None) -> tuple[Misconception, ...]:
    """All wrong works of all exercises, in the lessons' order; none where solutions were not installed.

    ``lessons``: by default all of the kit's.
    """
    if lessons is None:
        lessons = [read_lesson(lessons_folder() / name) for name in lesson_names()]
    try:
        solutions = solutions_folder()
    except FileNotFoundError:
        return ()
    folders = [
        (each, one, solutions / each.name / one.name / WRONG_FOLDER)
        for each in lessons
        for one in each.exercises
    ]
    return tuple(
        _misconception(lesson.name, exercise.name, work)
        for lesson, exercise, folder in folders
        if folder.is_dir()
        for work in sorted(folder.iterdir())
        if work.name[0] not in "._"
    )


def _misconception(lesson: str, exercise: str, work: Path) -> Misconception:
    criteria, _, why = (work.name if work.is_dir() else work.stem).partition("__")
    return Misconception(lesson, exercise, tuple(criteria.split("+")), why.replace("_", " "), _sentence(work))


def _sentence(work: Path) -> str:
    files = [file for file in sorted(work.rglob("*")) if file.is_file()] if work.is_dir() else [work]
    lines = (
        line.removeprefix(ADDED if file.suffix == EDITS else "")
        for file in files
        if file.suffix not in NO_TEXT
        for line in file.read_text().splitlines()
    )
    return next((line.removeprefix(QUOTE) for line in lines if line.startswith(QUOTE)), "")
