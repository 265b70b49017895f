"""The kit's own lessons, questions, maps and levels, each read once in a process: many tests look at all of them."""

from __future__ import annotations

from functools import cache
from typing import Any

from grader.kinds.function.kind import load_reference
from kit.school.game.levels import GameLevel, all_levels
from kit.school.lessons.reading import lessons_folder, read_lesson
from kit.school.lessons.records import Lesson
from kit.school.quiz.items import QuestionBank, read_bank
from kit.world.catalogue import MapCard, all_maps


@cache
def kit_lesson(name: str) -> Lesson:
    """The lesson of that name, ``01-drive``. Raises WorldError."""
    return read_lesson(lessons_folder() / name)


def lesson_reference(lesson: str, exercise: str) -> Any:
    """The module of a function exercise's reference."""
    return load_reference(lessons_folder() / lesson / exercise / "reference.py")


@cache
def kit_bank() -> QuestionBank:
    """The bank of all questions."""
    return read_bank()


@cache
def kit_maps() -> tuple[MapCard, ...]:
    """The cards of all maps."""
    return all_maps()


@cache
def kit_levels() -> tuple[GameLevel, ...]:
    """All levels of the game."""
    return all_levels()
