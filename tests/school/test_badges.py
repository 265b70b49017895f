"""Badges and days in a row, from the journal's events alone."""

from __future__ import annotations

from collections.abc import Iterable
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest
from click.testing import CliRunner

from kit.cli import main
from kit.school.badges import Badge, Streak, badge_table, badges, streak
from kit.school.lessons.catalogue import list_lessons
from kit.school.lessons.reading import read_units
from kit.school.progress import EventKind, ProgressEvent, ProgressJournal
from tests.kit_content import kit_lesson

NOON = datetime(2026, 5, 10, 12, tzinfo=UTC)
TODAY = NOON.astimezone().date()


def event(
    kind: EventKind, subject: str = "01-drive/1", days_ago: int = 0, **content: object
) -> ProgressEvent:
    at = NOON - timedelta(days=days_ago)
    return ProgressEvent(f"{kind}{subject}{days_ago}{content}", at.isoformat(), kind, subject, content)


def steps(*days_ago: int) -> list[ProgressEvent]:
    return [event(EventKind.STEP, days_ago=each) for each in days_ago]


def test_a_streak_ends_today_or_yesterday() -> None:
    assert streak(steps(0, 1, 2), TODAY) == Streak(3, 3)
    assert streak(steps(1, 2), TODAY) == Streak(2, 2)
    assert streak(steps(2, 3, 4), TODAY) == Streak(0, 3)
    assert streak(steps(0, 2, 3, 4, 4), TODAY) == Streak(1, 3)
    assert streak([], TODAY) == Streak(0, 0)


@pytest.mark.parametrize("kind", [EventKind.ABOUT, EventKind.FORM, EventKind.NEWS])
def test_what_is_told_and_read_is_no_learning(kind: EventKind) -> None:
    assert streak([event(kind, "name")], TODAY).days == 0


def test_a_clock_that_went_wrong_does_no_harm() -> None:
    assert streak(steps(-400, 0), TODAY).longest == 1


def earned(events: Iterable[ProgressEvent]) -> dict[str, Badge]:
    told = list(events)
    return {each.title: each for each in badges(list_lessons(told), read_units(), streak(told, TODAY), told)}


def passed(lesson: str, exercise: str) -> ProgressEvent:
    return event(
        EventKind.ATTEMPT, f"{lesson}/{exercise}", points=1.0, max_points=1.0, verdict="pass", lost=[]
    )


def test_each_unit_has_one() -> None:
    found = earned([])
    assert {unit.title for unit in read_units()} <= set(found)
    assert not any(each.done for each in found.values())
    assert len(found) > len(read_units())


def test_a_lesson_without_a_hint_and_at_the_first_try() -> None:
    lesson = kit_lesson("00-what-this-is-about")
    finished = [
        event(EventKind.STEP, lesson.step_subject(step)) for step in lesson.steps if step.exercise is None
    ]
    finished.append(passed(lesson.name, "who"))
    found = earned(finished)
    assert found["Unaided"].done == 1
    assert found["At the first try"].done == 1
    failed = event(
        EventKind.ATTEMPT, f"{lesson.name}/who", 1, points=0.0, max_points=1.0, verdict="fail", lost=["x"]
    )
    helped = event(EventKind.HINT, f"{lesson.name}/who/messages", step=1)
    found = earned([failed, helped, *finished])
    assert found["Unaided"].done == 0
    assert found["At the first try"].done == 0


def test_predictions_that_came_true() -> None:
    lesson = kit_lesson("20-q-learning")
    told = [
        event(
            EventKind.PREDICTION,
            lesson.step_subject(step),
            chosen=next(at for at, option in enumerate(step.options) if option.is_right == is_right),
            right=is_right,
        )
        for step, is_right in zip(
            (each for each in lesson.steps if each.options), (True, True, False), strict=False
        )
    ]
    assert earned(told)["Foresight"].done == 2


def test_what_is_earned_stands_first() -> None:
    table = badge_table([Badge("Begun", "a", 1, 2), Badge("Not yet", "b", 0, 2), Badge("Earned", "c", 2, 2)])
    assert [row[1] for row in table.rows] == ["Earned", "Begun", "Not yet"]


def test_kit_progress_shows_them(tmp_path: Path) -> None:
    with ProgressJournal(tmp_path) as journal:
        journal.add(EventKind.STEP, "01-drive/1")
        journal.add(
            EventKind.ATTEMPT,
            "01-drive/flag",
            {"points": 1.0, "max_points": 1.0, "verdict": "pass", "lost": []},
        )
    printed = (
        CliRunner().invoke(main, ["progress", "--workspace", str(tmp_path)], catch_exceptions=False).output
    )
    assert "1 day in a row" in printed
    assert "At the first try" in printed
    assert all(len(line) <= 80 for line in printed.splitlines())
