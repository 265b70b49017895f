"""Curves of trainings: read from what the grader says while a check trains."""

from __future__ import annotations

from grader.evidence.submission_clock import SubmissionClock, TrainingProgressReport
from kit.render.encode import AsciiEncoder
from kit.school.lessons.checking import CURVE_ROWS, TrainingCurves, read_training_curves


def told(*trainings: list[tuple[int, float]], count: int = 3, steps: int = 90_000) -> str:
    """What the grader says of trainings with these tests."""
    lines: list[str] = []
    for number, tests in enumerate(trainings, 1):
        progress = TrainingProgressReport(SubmissionClock(show_progress=lines.append), number, count, steps)
        progress.show(0)
        for after, success in tests:
            progress.add_test(after, success)
        progress.show_exam()
    return "".join(f"{line}\n" for line in lines)


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
