"""The lesson as a dialogue, without a face: what goes on while a student looks at another step."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from kit.dialogue.effects import Effect, Remark
from kit.school.lessons.lesson_dialogue import LessonDialogue
from kit.school.lessons.lesson_session import LessonSession
from kit.school.lessons.stage import NoStage
from tests.waiting import LIMIT_S


@pytest.fixture
def dialogue(session: LessonSession) -> Iterator[LessonDialogue]:
    """At the step with the exercise."""
    made = LessonDialogue(session)
    made.begin(NoStage())
    made.go_to("3")
    yield made
    made.close()


def polled(dialogue: LessonDialogue, until: Callable[[Effect], bool]) -> Effect:
    end = time.monotonic() + LIMIT_S
    while not until(effect := dialogue.poll()):
        assert time.monotonic() < end
        time.sleep(0.02)
    return effect


def answer(dialogue: LessonDialogue, colour: str) -> Path:
    assert dialogue.work is not None
    dialogue.work.file.write_text(f"colour: {colour}\n")
    return dialogue.work.file


def test_a_check_goes_on_while_another_step_is_looked_at(dialogue: LessonDialogue) -> None:
    answer(dialogue, "green")
    dialogue.check()
    assert dialogue.busy
    dialogue.go_to("2")
    assert not dialogue.busy, "the step has an explanation alone"
    assert dialogue.polls
    said = polled(dialogue, lambda effect: effect is not None)
    assert isinstance(said, Remark)
    assert "step 3" in said.text
    assert "passed" in said.text
    dialogue.go_to("3")
    assert dialogue.report is not None
    assert dialogue.report.is_passed
    assert not dialogue.busy


def test_what_was_saved_while_another_step_was_shown_is_checked_on_coming_back(
    dialogue: LessonDialogue,
) -> None:
    file = answer(dialogue, "red")
    dialogue.check()
    polled(dialogue, lambda effect: dialogue.report is not None)
    dialogue.go_to("1")
    file.write_text("colour: green # mended\n")
    assert not dialogue.polls
    dialogue.go_to("3")
    polled(dialogue, lambda effect: dialogue.report is not None and dialogue.report.is_passed)


def test_leaving_the_lesson_ends_every_check(dialogue: LessonDialogue) -> None:
    answer(dialogue, "green")
    dialogue.check()
    work = dialogue.work
    dialogue.go_to("2")
    dialogue.close()
    assert work is not None
    assert work.seconds is None
    assert dialogue.session.lesson_progress.passed_exercises == frozenset()
