"""All lessons beside each other, and where to go on."""

from __future__ import annotations

import shutil
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest

from kit.school.lessons.catalogue import LessonEntry, list_lessons, next_lesson
from kit.school.progress import EventKind, ProgressEvent
from tests.school.lessons.conftest import write_lesson

START = datetime(2030, 1, 1, tzinfo=UTC)


@pytest.fixture
def lessons(tmp_path: Path) -> Path:
    """Three lessons that differ in their names alone."""
    folder = tmp_path / "lessons"
    first = write_lesson(folder)
    for name in ("02-shapes", "03-sounds"):
        shutil.copytree(first, folder / name)
    return folder


def events(*told: tuple[EventKind, str]) -> list[ProgressEvent]:
    """One after the other, a minute apart. Attempts pass."""
    return [
        ProgressEvent(
            f"{number}",
            (START + timedelta(minutes=number)).isoformat(),
            kind,
            subject,
            {"points": 2.0, "max_points": 2.0, "verdict": "pass"} if kind is EventKind.ATTEMPT else {},
        )
        for number, (kind, subject) in enumerate(told)
    ]


def whole(name: str) -> tuple[tuple[EventKind, str], ...]:
    """All that is to be done in a lesson."""
    return (EventKind.STEP, f"{name}/1"), (EventKind.STEP, f"{name}/2"), (EventKind.ATTEMPT, f"{name}/colour")


def name_of(entry: LessonEntry | None) -> str:
    return "" if entry is None else entry.name


def test_a_new_student_begins_with_the_first(lessons: Path) -> None:
    entries = list_lessons([], lessons)
    assert [each.number for each in entries] == ["1", "2", "3"]
    assert not any(each.has_started or each.is_completed for each in entries)
    assert name_of(next_lesson(entries)) == "01-colours"


@pytest.mark.parametrize(
    ("told", "where"),
    [
        pytest.param([(EventKind.STEP, "02-shapes/1")], "02-shapes", id="where-one-was-last"),
        pytest.param([*whole("02-shapes")], "03-sounds", id="after-the-last-one-that-is-done"),
        pytest.param([*whole("03-sounds")], "01-colours", id="what-was-left-out"),
        pytest.param(
            [(EventKind.STEP, "03-sounds/1"), (EventKind.STEP, "01-colours/1")],
            "01-colours",
            id="the-newest-of-two",
        ),
        pytest.param(
            [*whole("01-colours"), *whole("02-shapes"), *whole("03-sounds")],
            "",
            id="nowhere-when-all-is-done",
        ),
    ],
)
def test_where_to_go_on(lessons: Path, told: list[tuple[EventKind, str]], where: str) -> None:
    assert name_of(next_lesson(list_lessons(events(*told), lessons))) == where


def test_units_set_the_order(lessons: Path) -> None:
    (lessons / "units.yaml").write_text(
        "units:\n  - {title: First, opener: Begin here., lessons: [03-sounds, 01-colours]}\n"
    )
    assert [each.number for each in list_lessons([], lessons)] == ["A1", "A2", "2"]
    assert name_of(next_lesson(list_lessons(events(*whole("01-colours")), lessons))) == "02-shapes"


def test_a_lesson_that_cannot_be_read_does_not_hide_the_others(lessons: Path) -> None:
    (lessons / "01-colours" / "lesson.yaml").write_text("title: Colours\nsteps: none\n")
    entries = list_lessons([], lessons)
    assert entries[0].lesson is None
    assert "lesson.yaml:2" in entries[0].problem
    assert entries[1].lesson is not None
    assert name_of(next_lesson(entries)) == "02-shapes"


def test_a_step_with_a_number_beyond_all_steps_is_no_step(lessons: Path) -> None:
    """Python refuses to read a number of 5,000 digits."""
    entries = list_lessons(events((EventKind.STEP, f"01-colours/{'9' * 5000}")), lessons)
    assert entries[0].progress is not None
    assert not any(map(entries[0].progress.is_step_completed, entries[0].progress.lesson.steps))
