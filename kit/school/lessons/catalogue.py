"""All lessons beside each other: which there are, what is done of each, and where to go on."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from kit.school.lessons.lesson_progress import Standing, standing
from kit.school.lessons.reading import lesson_names, lessons_folder, read
from kit.school.lessons.records import Lesson
from kit.school.progress import Event
from kit.world.problems import WorldError


@dataclass(frozen=True, slots=True)
class Entry:
    """One lesson of the list."""

    name: str
    """Its folder: ``01-drive``."""
    standing: Standing | None
    """What is done of it; None where it cannot be read."""
    problem: str = ""
    """Why it cannot be read."""

    @property
    def lesson(self) -> Lesson | None:
        return None if self.standing is None else self.standing.lesson

    @property
    def number(self) -> str:
        """As one counts: ``1``."""
        first = self.name.partition("-")[0]
        return first.lstrip("0") or first

    @property
    def title(self) -> str:
        return self.name if self.lesson is None else self.lesson.title

    @property
    def is_done(self) -> bool:
        return self.standing is not None and self.standing.is_done

    @property
    def is_begun(self) -> bool:
        return self.standing is not None and self.standing.is_begun


def entries(events: Sequence[Event], folder: Path | None = None) -> tuple[Entry, ...]:
    """Every lesson in order. One that cannot be read does not hide the others. FileNotFoundError where no lessons
    were installed."""
    folder = lessons_folder() if folder is None else folder
    return tuple(_entry(folder / name, events) for name in lesson_names(folder))


def going_on(shelf: Sequence[Entry]) -> Entry | None:
    """Where to go on: the lesson that was worked on last, if it is not done; else the first one after it that is
    not; else any that is not. None: all is done."""
    last = max(
        (index for index, each in enumerate(shelf) if each.is_begun),
        key=lambda index: _last(shelf[index]),
        default=0,
    )
    ahead = (*shelf[last:], *shelf[:last])
    return next((each for each in ahead if each.standing is not None and not each.is_done), None)


def _entry(folder: Path, events: Sequence[Event]) -> Entry:
    try:
        return Entry(folder.name, standing(read(folder), events))
    except (WorldError, OSError) as error:
        return Entry(folder.name, None, str(error))


def _last(entry: Entry) -> str:
    return "" if entry.standing is None else entry.standing.last
