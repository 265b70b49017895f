"""All lessons beside each other: which there are, what is done of each, and where to go on."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from kit.school.lessons.lesson_progress import LessonProgress, lesson_progress_from_events
from kit.school.lessons.reading import lesson_names, lessons_folder, read_lesson
from kit.school.lessons.records import Lesson
from kit.school.progress import ProgressEvent
from kit.world.problems import WorldError


@dataclass(frozen=True, slots=True)
class LessonEntry:
    """One lesson of the list."""

    name: str
    """Its folder: ``01-drive``."""
    progress: LessonProgress | None
    """What is done of it; None where it cannot be read."""
    problem: str = ""
    """Why it cannot be read."""

    @property
    def lesson(self) -> Lesson | None:
        return None if self.progress is None else self.progress.lesson

    @property
    def number(self) -> str:
        """As one counts: ``1``."""
        first = self.name.partition("-")[0]
        return first.lstrip("0") or first

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
    """Every lesson in order. One that cannot be read does not hide the others. FileNotFoundError where no lessons
    were installed."""
    folder = lessons_folder() if folder is None else folder
    return tuple(_entry(folder / name, events) for name in lesson_names(folder))


def next_lesson(entries: Sequence[LessonEntry]) -> LessonEntry | None:
    """Where to go on: the lesson that was worked on last, if it is not done; else the first one after it that is
    not; else any that is not. None: all is done."""
    last = max(
        (index for index, each in enumerate(entries) if each.has_started),
        key=lambda index: _last(entries[index]),
        default=0,
    )
    ahead = (*entries[last:], *entries[:last])
    return next((each for each in ahead if each.progress is not None and not each.is_completed), None)


def _entry(folder: Path, events: Sequence[ProgressEvent]) -> LessonEntry:
    try:
        return LessonEntry(folder.name, lesson_progress_from_events(read_lesson(folder), events))
    except (WorldError, OSError) as error:
        return LessonEntry(folder.name, None, str(error))


def _last(entry: LessonEntry) -> str:
    return "" if entry.progress is None else entry.progress.last_activity
