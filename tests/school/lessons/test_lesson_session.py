"""What a student does in a lesson, with the real grader in its own process."""

from __future__ import annotations

from pathlib import Path

import pytest

from kit.school.lessons.checking import Check, check
from kit.school.lessons.lesson_session import Visit
from kit.school.lessons.records import Lesson
from kit.school.progress import Kind, Progress
from kit.workspace import Workspace


def done(visit: Visit) -> list[int]:
    return [step.number for step in visit.lesson.steps if visit.standing.is_step_done(step)]


def test_the_first_prediction_is_kept(visit: Visit, progress: Progress) -> None:
    step = visit.lesson.steps[0]
    assert visit.foreseen(step) is None
    visit.foresee(step, 1)
    visit.foresee(step, 0)
    kept = visit.foreseen(step)
    assert kept is not None
    assert not kept.right
    assert [event.content["chosen"] for event in progress.events(Kind.PREDICTION)] == [1]
    with pytest.raises(IndexError):
        visit.foresee(step, 7)


def test_a_student_goes_through(
    visit: Visit, lesson: Lesson, workspace: Workspace, progress: Progress
) -> None:
    first, second, third = lesson.steps
    exercise = lesson.exercises[0]
    visit.go_through(first)
    visit.go_through(second)
    assert visit.first_step is third
    file = visit.lay_out(exercise)
    with visit.check(exercise) as running:
        blank = running.wait()
    visit.take(exercise, blank)
    assert not blank.is_passed
    assert "not answered yet" in blank.lost_criteria[0].rationale
    assert visit.solution(exercise) == {}
    said = [hint.text for _ in range(4) if (hint := visit.next_hint(exercise)) is not None]
    assert said == ["Look up.", "It grows on trees.", "It is green."]
    file.write_text("colour: red\n")
    with visit.check(exercise) as running:
        visit.take(exercise, running.wait())
    report = visit.report(exercise)
    assert report is not None
    assert "means stop" in report.lost_criteria[0].rationale
    file.write_text("colour: green\n")
    with visit.check(exercise) as running:
        visit.take(exercise, running.wait())
    assert done(visit) == [1, 2, 3]
    assert visit.standing.is_done
    assert visit.may_see_solution(exercise)
    again = Visit(lesson, progress, workspace)
    assert again.standing == visit.standing
    assert again.standing.attempts == {"colour": 3}
    assert again.standing.best == {"colour": 1.0}


def test_a_file_is_laid_out_once_and_begun_again_with_a_backup(visit: Visit, lesson: Lesson) -> None:
    exercise = lesson.exercises[0]
    file = visit.lay_out(exercise)
    file.write_text("colour: mine\n")
    assert visit.lay_out(exercise).read_text() == "colour: mine\n"
    kept = visit.begin_again(exercise)
    assert kept is not None
    assert (kept / "answers.yaml").read_text() == "colour: mine\n"
    assert file.read_text() == "colour:\n"


def test_what_cannot_be_checked_says_why(visit: Visit, lesson: Lesson, tmp_path: Path) -> None:
    exercise = lesson.exercises[0]
    missing = check(exercise, tmp_path / "nothing.yaml")
    assert missing.verdict == "fail"
    assert "not there" in missing.problem
    link = visit.lay_out(exercise)
    link.unlink()
    link.symlink_to("/etc/hostname")
    refused = check(exercise, link)
    assert refused.verdict == "fail"
    assert "link" in refused.problem
    (exercise.folder / "assignment.yaml").write_text("title: [")
    link.unlink()
    link.write_text("colour: green\n")
    broken = check(exercise, link)
    assert not broken.is_passed
    assert broken.problem


def test_a_broken_check_counts_for_nothing(visit: Visit, lesson: Lesson, progress: Progress) -> None:
    exercise = lesson.exercises[0]
    visit.take(exercise, check(exercise, Path("/nowhere/answers.yaml")))
    assert progress.events(Kind.ATTEMPT) == []


def test_a_check_can_be_left(visit: Visit, lesson: Lesson) -> None:
    exercise = lesson.exercises[0]
    running = Check(exercise, visit.lay_out(exercise))
    assert running.poll() is None
    running.close()
    running.close()
