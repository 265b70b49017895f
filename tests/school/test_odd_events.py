"""Entries that no kit wrote, such as those of an imported file that somebody edited: they are passed over, and
everything that is folded from the journal goes on working."""

from __future__ import annotations

import math
from datetime import UTC, datetime
from itertools import count

import pytest

from kit.school.form_answers import FormAnswers
from kit.school.form_reading import read_form
from kit.school.game.levels import GameLevel, all_levels
from kit.school.game.player_progress import level_progress
from kit.school.lessons.catalogue import lesson_progress_from_events
from kit.school.lessons.reading import find_lesson
from kit.school.progress import EventKind, ProgressEvent
from kit.school.quiz.answers import answers_from_events
from kit.school.quiz.items import QuestionBank, read_bank
from kit.school.quiz.schedule import build_schedule
from kit.school.report.class_data import student_work

ODD = {
    "none": None,
    "text": "x",
    "escape": "\x1b[2J",
    "list": [1],
    "mapping": {"a": 1},
    "infinite": math.inf,
    "not a number": math.nan,
    "negative": -5,
    "true": True,
    "vast": 10**400,
}


@pytest.fixture(scope="module")
def bank() -> QuestionBank:
    return read_bank()


@pytest.fixture(scope="module")
def levels() -> tuple[GameLevel, ...]:
    return all_levels()


@pytest.mark.parametrize("name", ODD)
def test_what_nobody_could_have_done_is_passed_over(
    bank: QuestionBank, levels: tuple[GameLevel, ...], name: str
) -> None:
    odd = ODD[name]
    numbers = count()
    item = bank.items[0].id

    def event(kind: EventKind, subject: str, **content: object) -> ProgressEvent:
        return ProgressEvent(f"{next(numbers)}", "2026-01-01T00:00:00.000000+00:00", kind, subject, content)

    events = [
        event(EventKind.STEP, "01-drive/²"),
        event(EventKind.STEP, "01-drive/" + "9" * 6000),
        event(EventKind.STEP, "\x1b[2J/1"),
        event(EventKind.PREDICTION, "01-drive/1", chosen=odd, right=odd),
        event(EventKind.ATTEMPT, "01-drive/flag", points=odd, max_points=odd, verdict="fail", lost=odd),
        event(EventKind.ATTEMPT, "01-drive/flag", points=odd, max_points=5.0, verdict="fail", seconds=odd),
        event(EventKind.ATTEMPT, "01-drive/readout", points=1.0, max_points=5.0, verdict=odd),
        event(EventKind.HINT, "01-drive/flag/reached", step=odd),
        event(EventKind.FINISH, "first-drive", driver="hand", reached=True, seconds=odd, bumps=0),
        event(EventKind.FINISH, "first-drive", driver="hand", reached=True, seconds=1.0, bumps=odd),
        event(EventKind.FINISH, "first-drive", driver=odd, reached=True, seconds=1.0, bumps=0),
        event(EventKind.ANSWER, item, chosen=odd, not_sure=odd, right=odd, confidence=odd, occasion="quiz"),
        event(EventKind.ANSWER, item, chosen=1, right=True, confidence=odd, occasion="spaced", topic=odd),
        event(EventKind.ANSWER, item, chosen=1, right=True, confidence=1, occasion=odd),
        event(EventKind.FORM, "experience.ros1", phase="before", value=odd),
        event(EventKind.FORM, "experience.ros1", phase=odd, value=3),
        event(EventKind.ABOUT, "name", value=odd),
    ]
    lesson = lesson_progress_from_events(find_lesson("1"), events)
    assert not lesson.is_completed
    assert all(0.0 <= share <= 1.0 for share in lesson.best_shares.values())
    assert student_work(events)["01-drive"].passed_count == 0
    for level in level_progress(levels, events):
        assert all(0.0 < seconds < math.inf for seconds in level.best_times.values())
    answers_from_events(events)
    build_schedule(bank, events, datetime(2026, 1, 9, tzinfo=UTC))
    FormAnswers.from_events(read_form(), events)
    assert events[-1].text("value") in ("", "x")
