"""The misconceptions that the wrong works stand for, exercise by exercise: ``python -m tests.solutions.misconceptions``.

A wrong work is called ``CRITERIA__why``: the criteria that it must lose, joined by ``+``, and what somebody believed who
wrote it. One that was written for a sentence of its lesson quotes it, in a comment that begins with ``Lesson:``.
"""

from __future__ import annotations

from itertools import groupby
from pathlib import Path
from typing import Final, NamedTuple

from kit.school.lessons.reading import lesson_names, lessons_folder, read_lesson, solutions_folder

QUOTE: Final = "# Lesson: "
NO_TEXT: Final = (".npz", ".png", ".dat")


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


def misconceptions() -> tuple[Misconception, ...]:
    """All wrong works of all exercises, in the lessons' order."""
    return tuple(
        _misconception(name, exercise.name, work)
        for name in lesson_names()
        for exercise in read_lesson(lessons_folder() / name).exercises
        for work in sorted((solutions_folder() / name / exercise.name / "wrong").iterdir())
        if work.name[0] not in "._"
    )


def _misconception(lesson: str, exercise: str, work: Path) -> Misconception:
    criteria, _, why = (work.name if work.is_dir() else work.stem).partition("__")
    return Misconception(lesson, exercise, tuple(criteria.split("+")), why.replace("_", " "), _sentence(work))


def _sentence(work: Path) -> str:
    files = [file for file in sorted(work.rglob("*")) if file.is_file()] if work.is_dir() else [work]
    lines = (line for file in files if file.suffix not in NO_TEXT for line in file.read_text().splitlines())
    return next((line.removeprefix(QUOTE) for line in lines if line.startswith(QUOTE)), "")


def main() -> None:
    for (lesson, exercise), found in groupby(misconceptions(), key=lambda each: each[:2]):
        print(f"{lesson}/{exercise}")
        for each in found:
            print(f"    {'+'.join(each.criteria):<36} {each.why}")
            if each.sentence:
                print(f"    {'':<36} “{each.sentence}”")


if __name__ == "__main__":
    main()
