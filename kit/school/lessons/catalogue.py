"""Lists all lessons with the student's progress, and finds the lesson to continue with."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from kit.school.lessons.lesson_progress import LessonProgress, lesson_progress_from_events
from kit.school.lessons.reading import lesson_names, lesson_number, lessons_folder, read_lesson, read_units
from kit.school.lessons.records import Lesson, LessonUnit
from kit.school.progress import ProgressEvent
from kit.world.problems import WorldError


@dataclass(frozen=True, slots=True)
class LessonEntry:
    """One lesson of the list."""

    name: str
    """The name of its folder: ``01-drive``."""
    number: str
    """Its number in the course: ``A2``."""
    progress: LessonProgress | None
    """The student's progress; None for a lesson that cannot be read."""
    problem: str = ""
    """Why the lesson cannot be read; else empty."""
    opened_unit: LessonUnit | None = None
    """The unit that begins with this lesson; None for the others."""

    @property
    def lesson(self) -> Lesson | None:
        return None if self.progress is None else self.progress.lesson

    @property
    def title(self) -> str:
        return self.name if self.lesson is None else self.lesson.title

    @property
    def is_completed(self) -> bool:
        return self.progress is not None and self.progress.is_completed

    @property
    def has_started(self) -> bool:
        return self.progress is not None and self.progress.has_started


def list_lessons(events: Sequence[ProgressEvent], folder: Path | None = None) -> tuple[LessonEntry, ...]:
    """Lists every lesson in order, including those that cannot be read. Raises FileNotFoundError where no lessons
    were installed."""
    folder = lessons_folder() if folder is None else folder
    openers = {unit.lessons[0]: unit for unit in read_units(folder) if unit.lessons}
    return tuple(
        replace(_read_entry(folder / name, events), opened_unit=openers.get(name))
        for name in lesson_names(folder)
    )


def next_lesson(entries: Sequence[LessonEntry]) -> LessonEntry | None:
    """Finds the lesson to continue with: the one worked on last, if it is not completed; else the first one after it
    that is not; else the first one at all that is not. None: all are completed."""
    last = max(
        (index for index, each in enumerate(entries) if each.has_started),
        key=lambda index: _last_activity(entries[index]),
        default=0,
    )
    ahead = (*entries[last:], *entries[:last])
    return next((each for each in ahead if each.progress is not None and not each.is_completed), None)


def _read_entry(folder: Path, events: Sequence[ProgressEvent]) -> LessonEntry:
    number = lesson_number(folder.name, folder.parent)
    try:
        return LessonEntry(folder.name, number, lesson_progress_from_events(read_lesson(folder), events))
    except (WorldError, OSError) as error:
        return LessonEntry(folder.name, number, None, str(error))


def _last_activity(entry: LessonEntry) -> str:
    return "" if entry.progress is None else entry.progress.last_activity
