"""One renderer of results: what every face shows of a criterion."""

from __future__ import annotations

from kit.school.result import CriterionResult, CriterionStatus
from kit.school.result_text import MARKS, criterion_lines, line_text, points_text, replay_lines
from tests.cases import every_case

LOST = CriterionResult(
    "near",
    "It comes near the target",
    CriterionStatus.PARTIAL,
    0.5,
    3.0,
    rationale="It stopped too early.",
    expected="at most 0.2 m",
    actual="1.7 m",
    hints=("Look at the laser.", "Look ahead.", "Use ranges[45]."),
    log="a\nb\nc\n",
    replay="..A..\n.....\n",
)
PASSED = CriterionResult(
    "runs", "It runs", CriterionStatus.PASS, 1.0, 1.0, rationale="unused", actual="unused"
)


def shown(criterion: CriterionResult, width: int = 76, **more: object) -> list[str]:
    return [line_text(line) for line in criterion_lines(criterion, width, **more)]  # type: ignore[arg-type]  # by name


def test_a_passed_criterion_is_one_line() -> None:
    assert shown(PASSED) == ["[ok] It runs: 1 of 1"]


def test_a_lost_criterion_shows_rationale_values_and_the_next_step() -> None:
    assert shown(LOST, hints=1, more_hints="More: --hints 2") == [
        "[part] It comes near the target: 0.5 of 3",
        "     It stopped too early.",
        "     expected: at most 0.2 m",
        "     actual:   1.7 m",
        "     Hint 1 of 3: Look at the laser.",
        "     More: --hints 2",
    ]


def test_no_more_hints_are_promised_than_there_are() -> None:
    assert not any("More" in line for line in shown(LOST, hints=3, more_hints="More: --hints 4"))


def test_the_last_lines_of_the_output_are_marked() -> None:
    assert shown(LOST, log_lines=2)[-3:] == ["     what the program printed:", "     | b", "     | c"]


@every_case("width", [24, 40, 80])
@every_case("status", CriterionStatus)
def test_nothing_is_wider_than_asked_and_nothing_is_lost(status: CriterionStatus, width: int) -> None:
    title = " ".join(f"word{number}" for number in range(15))
    lines = shown(CriterionResult("a", title, status, 2.0, 4.0, rationale=title), width)
    assert max(map(len, lines)) <= width
    text = " ".join(" ".join(lines).split())
    assert text.startswith(f"{MARKS[status]} {title}: ")
    assert "\0" not in text
    assert (title in text.split(":", 1)[1]) is (status is not CriterionStatus.PASS)


def test_the_picture_is_that_of_the_first_criterion_that_was_lost() -> None:
    assert replay_lines([PASSED, LOST]) == ["..A..", "....."]
    assert replay_lines([PASSED]) == []


def test_points_are_written_as_people_write_them() -> None:
    assert points_text(2.5, 4.0) == "2.5 of 4"
