"""Questions about the student's own program: what it does from a new start is run, and so the answers are facts."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import pytest

import kit
from kit.dialogue.dialogue import Turn
from kit.document.layout import lines_of
from kit.school.lessons.catalogue import lesson_progress_from_events
from kit.school.lessons.defence import DefenceError, prepare_defence
from kit.school.lessons.defence_dialogue import DefenceDialogue
from kit.school.lessons.reading import find_lesson
from kit.school.progress import EventKind, ProgressJournal
from kit.school.report.class_data import student_work
from kit.tui.rows.progress_marks import stars
from tests.driving_program import driving_program


def program(folder: Path, speed: float, turn: float) -> tuple[Path, Path]:
    """A program, and a recording of it."""
    file, run = folder / "steady.py", folder / "run.npz"
    file.write_text(driving_program(speed, turn))
    kit.run_episode("simple", str(file), seconds=1.0, seed=1, record=str(run))
    return file, run


@pytest.mark.long
@pytest.mark.parametrize(
    ("speed", "turn", "facts"),
    [(0.0, 0.0, [0, 2, 0]), (0.0, 1.0, [1, 0, 0]), (0.0, -1.0, [1, 1, 0])],
    ids=["stands", "turns left", "turns right"],
)
def test_the_run_decides_what_is_right(tmp_path: Path, speed: float, turn: float, facts: list[int]) -> None:
    file, run = program(tmp_path, speed, turn)
    defence = prepare_defence(file, run, 1001)
    assert [each.right for each in defence.questions] == facts
    assert defence.right_count(facts) == 3
    again = prepare_defence(file, run, 1001)
    assert (again.recording.poses == defence.recording.poses).all()
    other = prepare_defence(file, run, 1002)
    assert other.start != defence.start
    recorded: list[list[int]] = []
    session = SimpleNamespace(
        record_defence=lambda exercise, defence, answers: recorded.append(list(answers))
    )
    exercise = find_lesson("1").exercises[-1]
    dialogue = DefenceDialogue(session, exercise, defence)  # type: ignore[arg-type]  # keeps what is recorded
    turn = Turn(dialogue)
    assert dialogue.position == "question 1 of 3"
    for fact in facts:
        turn.press(str(fact + 1))
    assert recorded == [list(facts)]
    assert "one more star" in " ".join(lines_of(dialogue.blocks()))


@pytest.mark.long
def test_who_drives_straight_on_touches_a_wall_of_a_small_room(tmp_path: Path) -> None:
    file, run = program(tmp_path, 0.8, 0.0)
    defence = prepare_defence(file, run, 1003)
    assert defence.questions[2].right in (1, 2)
    assert defence.questions[1].right == 2


@pytest.mark.long
def test_a_program_that_stops_is_not_asked_about(tmp_path: Path) -> None:
    file, run = program(tmp_path, 0.0, 0.0)
    file.write_text(file.read_text().replace("command = Twist()", "command = Twist(nothing=1)"))
    with pytest.raises(DefenceError, match="Your program stopped"):
        prepare_defence(file, run, 1001)


def test_all_right_at_once_is_one_more_star_and_the_teacher_sees_it(tmp_path: Path) -> None:
    lesson = find_lesson("1")
    subject = f"{lesson.name}/square"
    with ProgressJournal(tmp_path) as journal:
        journal.add(EventKind.ATTEMPT, subject, {"verdict": "pass", "points": 8.0, "max_points": 8.0})
        journal.add(EventKind.DEFENCE, subject, {"asked": 3, "right": 2})
        assert stars(lesson_progress_from_events(lesson, journal.events()), "square") == "***"
        journal.add(EventKind.DEFENCE, subject, {"asked": 3, "right": 3})
        journal.add(EventKind.DEFENCE, f"{lesson.name}/readout", {"asked": 0, "right": 0})
        events = journal.events()
    progress = lesson_progress_from_events(lesson, events)
    assert stars(progress, "square") == "****"
    assert progress.defences["square"] == 2
    work = student_work(events)[lesson.name]
    assert (work.defended_count, work.defence_count) == (1, 3)
