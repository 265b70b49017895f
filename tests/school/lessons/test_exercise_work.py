"""An exercise on the bench: any of its files that is saved has it checked; one that a moment brings does not."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from kit.results.grading_result import PUBLIC_CASES
from kit.school.lessons.checking import ExerciseCheck, read_solution
from kit.school.lessons.exercise_work import ExerciseAttempt
from kit.school.lessons.lesson_session import LessonSession
from kit.school.progress import ProgressJournal
from kit.workspace import open_workspace
from tests.kit_content import kit_lesson


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
    [at] = [number for number, line in enumerate(written) if line.startswith(PUBLIC_CASES)]
    assert verdict in written[at]
    assert not any("secret" in line for line in written[:at])
    assert any("secret" in line for line in written[at:])
    assert all(each.startswith(PUBLIC_CASES) for each in seen if "secret" in each)
