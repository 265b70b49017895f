"""What a student does in a lesson, with the real grader in its own process."""

from __future__ import annotations

from pathlib import Path

import pytest

from kit.school.lessons.checking import ExerciseCheck, check_exercise
from kit.school.lessons.lesson_session import LessonSession
from kit.school.lessons.records import Lesson
from kit.school.progress import EventKind, ProgressJournal
from kit.workspace import Workspace


def done(visit: LessonSession) -> list[int]:
    return [step.number for step in visit.lesson.steps if visit.lesson_progress.is_step_completed(step)]


def test_the_first_prediction_is_kept(visit: LessonSession, progress: ProgressJournal) -> None:
    step = visit.lesson.steps[0]
    assert visit.prediction(step) is None
    visit.predict(step, 1)
    visit.predict(step, 0)
    kept = visit.prediction(step)
    assert kept is not None
    assert not kept.is_right
    assert [event.content["chosen"] for event in progress.events(EventKind.PREDICTION)] == [1]
    with pytest.raises(IndexError):
        visit.predict(step, 7)


def test_a_student_goes_through(
    visit: LessonSession, lesson: Lesson, workspace: Workspace, progress: ProgressJournal
) -> None:
    first, second, third = lesson.steps
    exercise = lesson.exercises[0]
    visit.complete_step(first)
    visit.complete_step(second)
    assert visit.first_step is third
    file = visit.install(exercise)
    with visit.start_check(exercise) as running:
        blank = running.wait()
    visit.record(exercise, blank)
    assert not blank.is_passed
    assert "not answered yet" in blank.lost_criteria[0].rationale
    assert visit.open_solution(exercise) == {}
    said = [hint.text for _ in range(4) if (hint := visit.next_hint(exercise)) is not None]
    assert said == ["Look up.", "It grows on trees.", "It is green."]
    file.write_text("colour: red\n")
    with visit.start_check(exercise) as running:
        visit.record(exercise, running.wait())
    report = visit.latest_report(exercise)
    assert report is not None
    assert "means stop" in report.lost_criteria[0].rationale
    file.write_text("colour: green\n")
    with visit.start_check(exercise) as running:
        visit.record(exercise, running.wait())
    assert done(visit) == [1, 2, 3]
    assert visit.lesson_progress.is_completed
    assert visit.can_see_solution(exercise)
    again = LessonSession(lesson, progress, workspace)
    assert again.lesson_progress == visit.lesson_progress
    assert again.lesson_progress.attempt_counts == {"colour": 3}
    assert again.lesson_progress.best_shares == {"colour": 1.0}


def test_a_file_is_laid_out_once_and_begun_again_with_a_backup(visit: LessonSession, lesson: Lesson) -> None:
    exercise = lesson.exercises[0]
    file = visit.install(exercise)
    file.write_text("colour: mine\n")
    assert visit.install(exercise).read_text() == "colour: mine\n"
    kept = visit.reset(exercise)
    assert kept is not None
    assert (kept / "answers.yaml").read_text() == "colour: mine\n"
    assert file.read_text() == "colour:\n"


def test_what_cannot_be_checked_says_why(visit: LessonSession, lesson: Lesson, tmp_path: Path) -> None:
    exercise = lesson.exercises[0]
    missing = check_exercise(exercise, tmp_path / "nothing.yaml")
    assert missing.verdict == "fail"
    assert "does not exist" in missing.problem
    link = visit.install(exercise)
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
    visit: LessonSession, lesson: Lesson, progress: ProgressJournal
) -> None:
    exercise = lesson.exercises[0]
    visit.record(exercise, check_exercise(exercise, Path("/nowhere/answers.yaml")))
    assert progress.events(EventKind.ATTEMPT) == []


def test_a_check_can_be_left(visit: LessonSession, lesson: Lesson) -> None:
    exercise = lesson.exercises[0]
    running = ExerciseCheck(exercise, visit.install(exercise))
    assert running.poll() is None
    running.close()
    running.close()
