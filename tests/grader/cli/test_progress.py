"""A long check shows what it is doing: to a screen that waits, on a terminal, and to nobody else."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from grader.cli.progress import counted_progress, shown_progress
from grader.evidence.submission_clock import DRIVE_KIND, SubmissionClock, TrainingProgressReport
from grader.grading import GradingOptions, grade
from grader.reading import read_assignment
from grader.submission import read_submission
from kit.host.sandbox.sandbox_config import Level
from kit.school.lessons.checking import ExerciseCheck
from kit.school.lessons.reading import find_lesson
from tests.grader.conftest import FORWARD, write_assignment

TWO_SEEDS = """
title: Drive on
submit: controller.py
level: 0
trials: [{name: turn, place: turn, time: 0.1, seeds: [1, 2]}]
checks:
  - {check: runs, points: 1}
  - {check: moves, points: 2, after: runs}
"""


def test_each_episode_is_shown_with_its_number(tmp_path: Path) -> None:
    shown: list[str] = []
    file = tmp_path / "controller.py"
    file.write_text(FORWARD)
    assignment = read_assignment(write_assignment(tmp_path / "task", TWO_SEEDS))
    options = GradingOptions(Level.LIMITED, show_progress=shown.append)
    grade(assignment, read_submission(file, assignment.submit), options)
    assert shown == ["episode 1 of 2: turn, seed 1", "episode 2 of 2: turn, seed 2"]


def test_a_training_shows_its_steps_and_the_curve_so_far() -> None:
    shown: list[str] = []
    progress = TrainingProgressReport(SubmissionClock(show_progress=shown.append), 2, 3, 120_000)
    for steps in range(0, 10_000, 100):
        progress.show(steps)
    assert shown[0] == "training 2 of 3: 0 of 120,000 steps"
    assert 2 <= len(shown) <= 6
    progress.add_test(10_000, 0.25)
    progress.add_test(20_000, 0.83)
    assert shown[-1] == "training 2 of 3: 20,000 of 120,000 steps, tests 25 83 %"
    progress.show_exam()
    assert shown[-1].startswith("training 2 of 3: exam")


def test_only_a_terminal_or_who_asked_is_told(capfd: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    with shown_progress(None) as show:
        show("episode 1 of 2: here")
    assert capfd.readouterr() == ("", "")
    with (tmp_path / "told").open("w+b") as told:
        with shown_progress(told.fileno()) as show:
            show("episode 1 of 2: \x1b[31m::notice::here")
            show("episode 1 of 2: the same, at once")
            show("episode 2 of 2: there")
        assert not os.get_inheritable(told.fileno())
    lines = (tmp_path / "told").read_text().splitlines()
    assert len(lines) == 2
    assert "\x1b" not in lines[0]
    assert "::" not in lines[0]
    assert lines[1] == "episode 2 of 2: there"


def test_what_is_to_be_drawn_goes_whole_to_who_asked_and_not_to_a_terminal(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    text = f"training 1 of 3{DRIVE_KIND}: {{{'1' * 900}}}"
    with (tmp_path / "told").open("w+b") as told, shown_progress(told.fileno()) as show:
        show(text)
    assert (tmp_path / "told").read_text() == f"{text}\n"
    monkeypatch.setattr("grader.cli.progress.FIRST_AFTER_S", 0.0)
    monkeypatch.setattr("sys.stderr.isatty", lambda: True, raising=False)
    with shown_progress(None) as show:
        show("training 1 of 3: 0 of 9 steps")
        show(text)
    shown = capfd.readouterr().err
    assert "0 of 9 steps" in shown
    assert "1111" not in shown


@pytest.mark.long
def test_a_lesson_that_waits_sees_the_trainings(tmp_path: Path) -> None:
    lesson = find_lesson("12")
    exercise = next(each for each in lesson.exercises if each.name == "stop")
    file = tmp_path / exercise.file
    file.write_text((exercise.folder / "starter.yaml").read_text())
    seen: set[str] = set()
    with ExerciseCheck(exercise, file) as running:
        while running.poll() is None:
            seen.add(running.progress)
        curves = running.training_curves
    assert any(each.startswith("training 1 of 3: ") and "tests " in each for each in seen)
    assert curves is not None
    assert len(curves.tests) == curves.count == 3
    assert curves.drive is not None
    assert curves.drive.training == 3
    assert not any("drive" in each for each in seen)


def test_a_self_test_says_which_work_it_tries(tmp_path: Path) -> None:
    from grader.self_test import try_works

    shown: list[str] = []
    folder = write_assignment(tmp_path / "task", TWO_SEEDS)
    for name in ("starter.py", "solution.py"):
        (folder / name).write_text(FORWARD)
    options = GradingOptions(Level.LIMITED, show_progress=shown.append)
    next(iter(try_works(read_assignment(folder), options)))
    assert shown == ["starter.py: episode 1 of 2: turn, seed 1", "starter.py: episode 2 of 2: turn, seed 2"]


def test_a_log_gets_a_line_from_time_to_time_and_the_last(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    now = 0.0
    monkeypatch.setattr("grader.cli.progress.time.monotonic", lambda: now)
    with counted_progress(40, "graded") as count_one:
        for _ in range(40):
            now += 1.0
            count_one()
    lines = capsys.readouterr().err.splitlines()
    assert lines == ["15 of 40 graded, 15 s", "30 of 40 graded, 30 s", "40 of 40 graded, 40 s"]
