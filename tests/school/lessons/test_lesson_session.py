"""What a student does in a lesson, with the real grader in its own process."""

from __future__ import annotations

from pathlib import Path

import pytest

from kit.school.lessons.checking import ExerciseCheck
from kit.school.lessons.lesson_session import LessonSession
from kit.school.lessons.records import Lesson
from kit.school.progress import EventKind, ProgressJournal
from kit.workspace import Workspace
from tests.exercise_checks import check_exercise
from tests.school.lessons.check_reports import lost, report_of


def done(session: LessonSession) -> list[int]:
    return [step.number for step in session.lesson.steps if session.lesson_progress.is_step_completed(step)]


def test_the_first_prediction_is_kept(session: LessonSession, journal: ProgressJournal) -> None:
    step = session.lesson.steps[0]
    assert session.prediction(step) is None
    session.predict(step, 1)
    session.predict(step, 0)
    kept = session.prediction(step)
    assert kept is not None
    assert not kept.is_right
    assert [event.content["chosen"] for event in journal.events(EventKind.PREDICTION)] == [1]
    with pytest.raises(IndexError):
        session.predict(step, 7)


@pytest.mark.long
def test_a_student_goes_through(
    session: LessonSession, lesson: Lesson, workspace: Workspace, journal: ProgressJournal
) -> None:
    first, second, third = lesson.steps
    exercise = lesson.exercises[0]
    session.complete_step(first)
    session.complete_step(second)
    assert session.first_step is third
    file = session.install(exercise)
    with session.start_check(exercise) as running:
        blank = running.wait()
    session.record(exercise, blank)
    assert not blank.is_passed
    assert "not answered yet" in blank.lost_criteria[0].rationale
    assert session.open_solution(exercise) == {}
    said = [hint.text for _ in range(4) if (hint := session.next_hint(exercise)) is not None]
    assert said == ["Look up.", "It grows on trees.", "It is green."]
    file.write_text("colour: red\n")
    with session.start_check(exercise) as running:
        session.record(exercise, running.wait())
    report = session.latest_report(exercise)
    assert report is not None
    assert "means stop" in report.lost_criteria[0].rationale
    file.write_text("colour: green\n")
    with session.start_check(exercise) as running:
        session.record(exercise, running.wait())
    assert done(session) == [1, 2, 3]
    assert session.lesson_progress.is_completed
    assert session.can_see_solution(exercise)
    again = LessonSession(lesson, journal, workspace)
    assert again.lesson_progress == session.lesson_progress
    assert again.lesson_progress.attempt_counts == {"colour": 3}
    assert again.lesson_progress.best_shares == {"colour": 1.0}


def test_files_are_installed_once_and_reset_with_a_backup(session: LessonSession, lesson: Lesson) -> None:
    exercise = lesson.exercises[0]
    file = session.install(exercise)
    file.write_text("colour: mine\n")
    assert session.install(exercise).read_text() == "colour: mine\n"
    kept = session.reset(exercise)
    assert kept is not None
    assert (kept / "answers.yaml").read_text() == "colour: mine\n"
    assert file.read_text() == "colour:\n"


@pytest.mark.long
def test_what_cannot_be_checked_says_why(session: LessonSession, lesson: Lesson, tmp_path: Path) -> None:
    exercise = lesson.exercises[0]
    missing = check_exercise(exercise, tmp_path / "nothing.yaml")
    assert missing.verdict == "fail"
    assert "does not exist" in missing.problem
    link = session.install(exercise)
    link.unlink()
    link.symlink_to("/etc/hostname")
    refused = check_exercise(exercise, link)
    assert refused.verdict == "fail"
    assert "link" in refused.problem
    (exercise.folder / "assignment.yaml").write_text("title: [")
    link.unlink()
    link.write_text("colour: green\n")
    broken = check_exercise(exercise, link)
    assert not broken.is_passed
    assert broken.problem


def test_a_broken_check_counts_for_nothing(
    session: LessonSession, lesson: Lesson, journal: ProgressJournal
) -> None:
    exercise = lesson.exercises[0]
    session.record(exercise, check_exercise(exercise, Path("/nowhere/answers.yaml")))
    assert journal.events(EventKind.ATTEMPT) == []


def test_a_check_can_be_left(session: LessonSession, lesson: Lesson) -> None:
    exercise = lesson.exercises[0]
    running = ExerciseCheck(exercise, session.install(exercise))
    assert running.poll() is None
    running.close()
    running.close()


def test_hints_go_on_to_every_lost_criterion_and_known_mistakes_are_said_first(
    session: LessonSession, lesson: Lesson
) -> None:
    exercise = lesson.exercises[0]
    told = lost("told", "The very mistake.", "More of it.", knows_mistake=True)
    also = lost("also", "Another mistake.", "How to mend it.", knows_mistake=True)
    session.record(
        exercise, report_of(lost("first", "A."), lost("mute"), told, also, lost("last", "B.", "C."))
    )
    said = []
    while session.has_closed_hints(exercise):
        hint = session.next_hint(exercise)
        assert hint is not None
        assert hint in session.opened_hints(exercise)
        said.append((hint.criterion.id, hint.number, hint.text))
    assert said == [
        ("told", 1, "The very mistake."),
        ("also", 1, "Another mistake."),
        ("told", 2, "More of it."),
        ("also", 2, "How to mend it."),
        ("first", 1, "A."),
        ("last", 1, "B."),
        ("last", 2, "C."),
    ]
    assert session.next_hint(exercise) is None
    session.record(exercise, report_of(lost("last", "B.", "C."), lost("new", "D.")))
    assert [hint.text for hint in session.opened_hints(exercise)] == ["B.", "C."]
    assert session.has_closed_hints(exercise)
