"""An exercise on the bench: where an editor begins, which file it opens, and what a check tells while it runs."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from kit.results.grading_result import PUBLIC_CASES
from kit.school.lessons.checking import ExerciseCheck, has_other_files, read_solution
from kit.school.lessons.exercise_work import ExerciseAttempt
from kit.school.lessons.lesson_session import LessonSession
from kit.school.lessons.reading import lesson_names, lessons_folder, read_lesson
from kit.school.progress import ProgressJournal
from kit.workspace import open_workspace
from tests.kit_content import kit_lesson
from tests.school.lessons.check_reports import lost, report_of


def test_an_editor_begins_at_the_first_todo_and_then_at_the_error(tmp_path: Path) -> None:
    lesson = kit_lesson("02-nodes-and-topics")
    exercise = lesson.exercises[0]
    with ProgressJournal(tmp_path) as journal:
        session = LessonSession(lesson, journal, open_workspace(tmp_path))
        model = ExerciseAttempt(session, exercise)
        lines = model.file.read_text().splitlines()
        assert "TODO" in lines[model.line_to_edit - 1]
        assert not any("TODO" in line for line in lines[: model.line_to_edit - 1])
        model.file.write_text("\n".join([*lines[:4], "oh no", *lines[4:]]))
        with session.start_check(exercise) as running:
            session.record(exercise, running.wait())
        assert model.line_to_edit == 5
        model.file.write_text("nothing is open here")
        session.reset(exercise)
        model.file.write_text("pass\n\npass")
        assert model.line_to_edit == 1


def test_an_editor_begins_at_the_first_question_without_an_answer(tmp_path: Path) -> None:
    lesson = kit_lesson("01-drive")
    exercise = next(each for each in lesson.exercises if each.name == "readout")
    with ProgressJournal(tmp_path) as journal:
        model = ExerciseAttempt(LessonSession(lesson, journal, open_workspace(tmp_path)), exercise)
        lines = model.file.read_text().splitlines()
        first, second = [number for number, line in enumerate(lines, 1) if line.endswith(":")][:2]
        assert model.line_to_edit == first
        lines[first - 1] += " /odom"
        model.file.write_text("\n".join(lines))
        assert model.line_to_edit == second
        model.file.write_text("layers:\n  - a\nlasers:\n- b\n")
        assert model.line_to_edit == 1, "whoever holds something is no question"


def works_of_folders(tmp_path: Path, journal: ProgressJournal) -> Iterator[tuple[str, ExerciseAttempt]]:
    """The kit's exercises with several files, and the words of their steps."""
    for name in lesson_names():
        session = LessonSession(read_lesson(lessons_folder() / name), journal, open_workspace(tmp_path))
        for step in session.lesson.steps:
            if step.exercise is not None and has_other_files(step.exercise):
                yield step.text, ExerciseAttempt(session, step.exercise)


def test_the_file_that_a_step_talks_about_is_the_one_that_is_suggested(tmp_path: Path) -> None:
    with ProgressJournal(tmp_path) as journal:
        for told, work in works_of_folders(tmp_path, journal):
            suggested = work.suggested_file(told)
            words = told.replace("{file}", work.exercise.file).replace("{folder}", "")
            assert suggested.name in words or suggested.stem in words.split(), words
            assert suggested in work.files(told)


def test_after_the_first_file_the_one_to_hand_in_is_suggested_and_first_of_all_the_one_with_an_error(
    tmp_path: Path,
) -> None:
    with ProgressJournal(tmp_path) as journal:
        told, draft = next(
            each for each in works_of_folders(tmp_path, journal) if each[1].exercise.name == "draft"
        )
        course, task = draft.file.with_name("course.txt"), draft.file
        assert draft.files(told) == [course, task]
        assert (draft.suggested_file(told), draft.edited_file) == (course, course)
        course.write_text("###\n")
        assert draft.suggested_file(told) == task
        draft.choose(task)
        assert draft.edited_file == task
        assert "summary" in draft.edited_lines()[0]
        task.write_text("summary: mine\n")
        draft.choose(course)
        assert draft.suggested_file(told) == course, "the one that was edited last"
        draft.session.record(draft.exercise, report_of(replace(lost("a"), rationale="(1) task.yaml:1:3: no")))
        assert draft.suggested_file(told) == task
        draft.choose(task)
        assert (draft.line_to_edit, draft.error_text) == (1, "no")


@pytest.mark.long
@pytest.mark.parametrize(
    ("old", "new", "verdict"), [("", "", "all passed"), ("max(table", "min(table", "of 3 criteria passed")]
)
def test_the_public_verdict_is_told_before_the_secret_cases(
    old: str, new: str, verdict: str, tmp_path: Path
) -> None:
    """What is told then stays in sight while the rest runs."""
    lesson = kit_lesson("20-q-learning")
    exercise = next(each for each in lesson.exercises if each.name == "agent")
    file = tmp_path / "agent.py"
    file.write_text(read_solution(lesson, exercise)["agent.py"].replace(old, new))
    seen: set[str] = set()
    with ExerciseCheck(exercise, file) as check:
        while check.poll() is None:
            seen.add(check.progress)
        written = os.pread(check._progress.fileno(), 1 << 16, 0).decode().splitlines()
    assert "reading" in written[0], "said before anything is run, and before what runs it is imported"
    [at] = [number for number, line in enumerate(written) if line.startswith(PUBLIC_CASES)]
    assert verdict in written[at]
    assert not any("secret" in line for line in written[:at])
    assert any("secret" in line for line in written[at:])
    assert all(each.startswith(PUBLIC_CASES) for each in seen if "secret" in each)
