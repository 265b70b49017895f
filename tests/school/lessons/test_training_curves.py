"""Curves of trainings: read from what the grader says while a check trains."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from grader.evidence.submission_clock import SubmissionClock, TrainingProgressReport
from kit.render.drive_playback import DrivenPlace, DrivePlayback
from kit.render.encode import AsciiEncoder
from kit.render.scene import Disc
from kit.school.lessons.training_curves import (
    CURVE_ROWS,
    HOLD_S,
    LONGEST_SHOWN_S,
    DriveLoop,
    TestDrive,
    TrainingCurves,
    is_drive_line,
    read_training_curves,
)


def told(*trainings: list[tuple[int, float]], count: int = 3, steps: int = 90_000) -> str:
    """What the grader says of trainings with these tests."""
    lines: list[str] = []
    clock = SubmissionClock(show_progress=lines.append)
    _tell(clock, trainings, count, steps)
    return "".join(f"{line}\n" for line in lines)


def _tell(
    clock: SubmissionClock, trainings: Sequence[list[tuple[int, float]]], count: int, steps: int
) -> None:
    for number, tests in enumerate(trainings, 1):
        progress = TrainingProgressReport(clock, number, count, steps)
        progress.show(0)
        for after, success in tests:
            progress.add_test(after, success)
        progress.show_exam()


def test_three_trainings_are_three_curves() -> None:
    text = told([(10_000, 0.25), (20_000, 0.833)], [(10_000, 0.5)], [(10_000, 1.0)])
    curves = read_training_curves(text)
    assert curves == TrainingCurves(
        3, 90_000, (((10_000, 25), (20_000, 83)), ((10_000, 50),), ((10_000, 100),))
    )
    picture = curves.picture(76, AsciiEncoder())
    assert len(picture) == CURVE_ROWS
    assert all(f"training {number}" in picture[0] for number in (1, 2, 3))
    assert all(len(row) <= 76 and row.isascii() for row in picture)
    assert curves.describe()[0] == "training 1 of 3: tests 25 83 %"


def test_the_figure_that_is_judged_stands_beside_the_curve() -> None:
    """That of the exam, which may be far from the last test."""
    text = told([(90_000, 0.42)], [(90_000, 0.32)], count=2)
    curves = read_training_curves(f"{text}training 1 of 2, exam: 58 %\n")
    assert curves is not None
    assert curves.exams == {1: 58}
    for columns in (60, 76):
        names = curves.picture(columns, AsciiEncoder())[0]
        assert "exam 0.58; last 0.42" in names
        assert "training 2" in names
        assert names.count("exam") == 1
    assert curves.describe() == [
        "training 1 of 2: tests 42 %, exam 58 %",
        "training 2 of 2: tests 32 %",
    ]


def test_a_curve_grows_with_what_is_said() -> None:
    whole = told([(30_000, 0.2), (60_000, 0.7), (90_000, 0.9)])
    pictures = []
    for tests in (1, 2, 3):
        lines = whole.splitlines(keepends=True)
        ends = [number for number, line in enumerate(lines, 1) if ", test:" in line]
        curves = read_training_curves("".join(lines[: ends[tests - 1]]))
        assert curves is not None
        assert len(curves.tests[0]) == tests
        pictures.append(curves.picture(60, AsciiEncoder()))
    assert len({tuple(each) for each in pictures}) == 3


def test_a_check_without_trainings_has_none_and_a_torn_line_counts_not() -> None:
    assert read_training_curves("episode 1 of 2: maze, seed 1\n") is None
    assert read_training_curves(told([]) + "training 1 of 3, test: 40 % aft") is None


def drive(case: str = "there", x: float = 2.0, seconds: float = 2.0) -> DrivePlayback:
    poses = np.array([[[0.5, 1.0, 0.0]], [[x, 1.0, 0.0]]])
    walls = np.array([[0.0, 0, 4, 0], [4, 0, 4, 3], [4, 3, 0, 3], [0, 3, 0, 0]])
    place = DrivenPlace(walls, (np.array([[0.1, 0.1], [-0.1, 0.1], [-0.1, -0.1]]),), Disc(3.0, 1.0, 0.2))
    return DrivePlayback(case, f"hit a wall after {seconds:.1f} s", poses, seconds, place)


def told_drives(*drives: DrivePlayback) -> str:
    lines: list[str] = []
    progress = TrainingProgressReport(SubmissionClock(show_progress=lines.append), 1, 3, 90_000)
    for number, each in enumerate(drives, 1):
        progress.add_test(number * 10_000, 0.5, each)
    return "".join(f"{line}\n" for line in lines)


def test_the_newest_drive_is_shown_beside_the_curves_and_said_in_words() -> None:
    text = told_drives(drive(), drive("back"), drive(x=3.0, seconds=4.0))
    assert text.count('"walls"') == 2  # each case's place is told once
    curves = read_training_curves(text)
    assert curves is not None
    assert curves.drive is not None
    assert curves.describe()[-1] == "training 1, test at 30,000 steps: there, hit a wall after 4.0 s"
    start, end = (curves.picture(76, AsciiEncoder(), curves.drive, time_s) for time_s in (0.0, None))
    assert start != end
    for picture in (start, end):
        assert len(picture) == CURVE_ROWS
        assert all(len(row) <= 76 for row in picture)
        assert "training 1" in picture[0]
        assert all(len(row) <= 76 for row in picture)
    assert start[-1].endswith(" 0.0 s")
    assert end[-1].endswith("hit a wall after 4.0 s")
    assert len(curves.picture(76, AsciiEncoder(), curves.drive, None, 14)) == 14
    narrow = curves.picture(50, AsciiEncoder(), curves.drive, 0.0)
    assert narrow == curves.picture(50, AsciiEncoder())


def test_a_drive_that_is_damaged_leaves_the_curves() -> None:
    text = told_drives(drive()).replace('"poses"', '"pose"')
    curves = read_training_curves(text)
    assert curves is not None
    assert curves.drive is None
    assert is_drive_line(text.splitlines()[0])
    assert not is_drive_line(text.splitlines()[1])


def test_a_newer_drive_waits_until_the_one_before_is_over() -> None:
    first, second = (TestDrive(1, steps, drive(seconds=6.0)) for steps in (10_000, 20_000))
    loop = DriveLoop()
    assert loop.advance(None, 99.0) == (None, 0.0)
    assert loop.advance(first, 100.0) == (first, 0.0)
    shown, time_s = loop.advance(second, 100.0 + LONGEST_SHOWN_S / 2)
    assert shown is first
    assert abs(time_s - 3.0) < 1e-6
    over = 100.0 + LONGEST_SHOWN_S + HOLD_S + 0.01
    assert loop.advance(second, over) == (second, 0.0)
    assert loop.advance(second, over + 1.0)[1] > 0.0
    assert loop.advance(second, over + LONGEST_SHOWN_S + HOLD_S + 0.01) == (second, 0.0)  # and again
