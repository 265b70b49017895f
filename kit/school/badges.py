"""Badges and the days in a row: what a student has earned by learning, computed from the journal and never stored."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from datetime import date, timedelta
from typing import Final

from kit.document.blocks import Cell, CellStyle, Column, Table
from kit.plain_text import counted
from kit.school.lessons.catalogue import LessonEntry, LessonProgress
from kit.school.lessons.records import LessonUnit
from kit.school.progress import EventKind, ProgressEvent

IDLE: Final = (EventKind.ABOUT, EventKind.FORM, EventKind.NEWS)
"""Events that are no learning: a day with these alone does not count."""
FIRST_TRIES: Final = 10
FORESEEN: Final = 20
UNAIDED: Final = 5
DEFENDED: Final = 3
DAYS: Final = 7


@dataclass(frozen=True, slots=True)
class Badge:
    """Something to be earned."""

    title: str
    how: str
    """What earns it, in a few words."""
    done: int
    """How far one is, at most ``needed``."""
    needed: int

    @property
    def is_earned(self) -> bool:
        return self.done >= self.needed


@dataclass(frozen=True, slots=True)
class Streak:
    """Days in a row on which something was learned."""

    days: int
    """Up to today, or to yesterday where today has not begun; 0: it is broken."""
    longest: int

    def describe(self) -> str:
        """``3 days in a row; the longest so far: 5``."""
        now = f"{counted(self.days, 'day')} in a row" if self.days else "No day in a row yet"
        return f"{now}; the longest so far: {self.longest}."


def learning_days(events: Iterable[ProgressEvent]) -> Counter[date]:
    """How many things were learned on each day on which any was: a step, a prediction, a check, an answer, a drive."""
    return Counter(event.time.astimezone().date() for event in events if event.kind not in IDLE)


def streak(events: Iterable[ProgressEvent], today: date) -> Streak:
    """The days in a row on which anything was learned. ``today``: in the time zone in which a day of the student begins and
    ends."""
    days = sorted(learning_days(events))
    longest = current = 0
    before: date | None = None
    for day in days:
        current = current + 1 if before is not None and day - before == timedelta(days=1) else 1
        longest, before = max(longest, current), day
    is_alive = before is not None and today - before <= timedelta(days=1)
    return Streak(current if is_alive else 0, longest)


def badges(
    shelf: Sequence[LessonEntry], units: Sequence[LessonUnit], days: Streak, events: Sequence[ProgressEvent]
) -> tuple[Badge, ...]:
    """All badges, each with how far the student is."""
    started = [each.progress for each in shelf if each.progress is not None]
    finished = {each.name for each in shelf if each.is_completed}
    of_units = (
        Badge(
            unit.title,
            f"finish unit {unit.letter}",
            sum(name in finished for name in unit.lessons),
            len(unit.lessons),
        )
        for unit in units
    )
    return (
        *of_units,
        _make_badge(
            "At the first try", "exercises passed by their first check", _first_tries(events), FIRST_TRIES
        ),
        _make_badge(
            "Foresight", "predictions that came true", _sum_over(started, _count_right_predictions), FORESEEN
        ),
        _make_badge("Unaided", "lessons finished without a hint", _sum_over(started, _is_unaided), UNAIDED),
        _make_badge(
            "Knows why",
            "programs defended",
            _sum_over(started, lambda each: len(each.defended_exercises)),
            DEFENDED,
        ),
        _make_badge("A week", "days in a row", days.longest, DAYS),
    )


def badge_table(shown: Sequence[Badge]) -> Table:
    """The badges that are earned first, then those that are begun, then the others."""
    columns = (
        Column("", CellStyle.TEXT),
        Column("badge", CellStyle.TEXT),
        Column("for", CellStyle.TEXT),
        Column("so far"),
    )
    ordered = sorted(shown, key=lambda each: (not each.is_earned, not each.done))

    def cells(each: Badge) -> tuple[Cell, ...]:
        return "*" if each.is_earned else "", each.title, each.how, f"{each.done} of {each.needed}"

    return Table("badges", "", columns, tuple(map(cells, ordered)), is_ruled=False)


def _make_badge(title: str, how: str, done: int, needed: int) -> Badge:
    return Badge(title, f"{needed} {how}", min(done, needed), needed)


def _sum_over(started: Iterable[LessonProgress], count: Callable[[LessonProgress], int]) -> int:
    return sum(map(count, started))


def _first_tries(events: Iterable[ProgressEvent]) -> int:
    """Exercises whose first check passed."""
    first = {
        event.subject: event
        for event in reversed([each for each in events if each.kind is EventKind.ATTEMPT])
    }
    return sum(event.content.get("verdict") == "pass" for event in first.values())


def _count_right_predictions(progress: LessonProgress) -> int:
    """Predictions that were right."""
    return sum(
        0 <= chosen < len(step.options) and step.options[chosen].is_right
        for step in progress.lesson.steps
        if (chosen := progress.predictions.get(step.number)) is not None
    )


def _is_unaided(progress: LessonProgress) -> bool:
    return progress.is_completed and bool(progress.lesson.exercises) and not progress.opened_hints
