"""The kit's own lessons, each read once in a process: many tests look at all of them."""

from __future__ import annotations

from functools import cache

from kit.school.lessons.reading import lessons_folder, read_lesson
from kit.school.lessons.records import Lesson


@cache
def kit_lesson(name: str) -> Lesson:
    """The lesson of that name, ``01-drive``. Raises WorldError."""
    return read_lesson(lessons_folder() / name)
