"""The lesson as a dialogue, without a face: what goes on while a student looks at another step."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from kit.dialogue.dialogue import Turn
from kit.dialogue.effects import Choose, Effect, Remark, Show
from kit.school.lessons.lesson_dialogue import EditHere, LessonDialogue
from kit.school.lessons.lesson_session import LessonSession
from kit.school.lessons.reading import lesson_names, lessons_folder, read_lesson
from kit.school.lessons.stage import NoStage
from kit.school.progress import ProgressJournal
from kit.workspace import Workspace
from tests.school.lessons.check_reports import lost, report_of
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


def test_the_newest_hint_is_what_is_looked_at_and_no_key_is_named_for_one_more(
    dialogue: LessonDialogue,
) -> None:
    assert dialogue.work is not None
    report = report_of(lost("first", "Same words."), lost("second", "Others.", "More."))
    dialogue.session.record(dialogue.work.exercise, report)
    turn, seen = Turn(dialogue), []
    while dialogue.can_hint() is True:
        assert "h" in str(dialogue.note and dialogue.note.text).split()
        assert turn.press("h") is None
        look = dialogue.block_in_view
        assert look is not None
        seen.append(dialogue.reply_blocks().index(look))
    assert seen == sorted(set(seen)), "each is another block, and stands below those before it"
    assert len(seen) == 3
    assert "h" not in str(dialogue.note and dialogue.note.text).split()
    said = turn.press("h")
    assert isinstance(said, Remark)
    assert "all hints" in said.text


def test_while_keys_are_letters_of_the_program_only_the_editors_are_named(dialogue: LessonDialogue) -> None:
    def noted(*, writing: bool) -> str:
        dialogue.is_writing = writing
        assert dialogue.note is not None
        return dialogue.note.text

    assert "press c" in noted(writing=False)
    assert "^S" in noted(writing=True)
    assert "press" not in noted(writing=True).lower()
    assert dialogue.work is not None
    dialogue.session.record(dialogue.work.exercise, report_of(lost("first", "Do.")))
    assert "Press h" in noted(writing=False)
    assert "Esc, then h" in noted(writing=True)


@pytest.mark.parametrize("name", lesson_names())
def test_no_key_stands_twice_on_the_page_of_help(
    name: str, journal: ProgressJournal, workspace: Workspace
) -> None:
    session = LessonSession(read_lesson(lessons_folder() / name), journal, workspace)
    dialogue = LessonDialogue(session)
    turn = Turn(dialogue)
    for step in session.lesson.steps:
        dialogue.step = step
        hidden = turn.hidden_by_others()
        keys = [key for each in dialogue.actions if each not in hidden for key in each.keys.key_names]
        assert sorted(set(keys)) == sorted(keys)
        assert not [each.id for each in turn.possible() if each in hidden]


def test_of_several_files_one_is_chosen_and_then_stays_the_one_that_is_shown(
    journal: ProgressJournal, workspace: Workspace
) -> None:
    session = LessonSession(read_lesson(lessons_folder() / "41-capstone"), journal, workspace)
    dialogue = LessonDialogue(session)
    dialogue.begin(NoStage())
    dialogue.go_to("3")
    asked = dialogue.edit_here()
    assert isinstance(asked, Choose)
    assert [each.name for each in asked.options] == ["course.txt", "task.yaml"]
    assert asked.selected == 0
    assert asked.then(None) is None
    opened = asked.then(1)
    assert isinstance(opened, Show)
    assert isinstance(opened.request, EditHere)
    assert opened.request.file.name == "task.yaml"
    assert dialogue.work is not None
    assert dialogue.work.edited_file == opened.request.file
    dialogue.close()


def test_a_file_saved_while_it_is_checked_is_checked_at_once_in_place_of_the_older_one(
    dialogue: LessonDialogue,
) -> None:
    file = answer(dialogue, "red")
    dialogue.check()
    file.write_text("colour: green # mended\n")
    polled(dialogue, lambda effect: dialogue.report is not None)
    assert dialogue.report is not None
    assert dialogue.report.is_passed, "the first report is that of the newer file"


def test_a_key_that_came_too_late_or_too_early_says_so(dialogue: LessonDialogue) -> None:
    turn = Turn(dialogue)
    dialogue.go_to("1")
    early = turn.press("k")
    assert isinstance(early, Remark)
    assert str(len(dialogue.session.lesson.steps)) in early.text, "the last step"
    if dialogue.step.options:
        turn.press("1")
        late = turn.press("2")
        assert isinstance(late, Remark)
        assert "predicted 1" in late.text
