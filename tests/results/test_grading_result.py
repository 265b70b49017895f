"""The record of a grading run: what it adds up to, what it never lets through."""

from __future__ import annotations

import json
import math

import pytest

from kit.document.layout import Page, lines_of
from kit.results.grading_result import (
    MAX_LOG_LENGTH,
    CriterionResult,
    CriterionStatus,
    EpisodeSummary,
    GradingResult,
    GradingVerdict,
    Visibility,
)
from kit.results.result_blocks import (
    MARKS,
    MAX_RATIONALE,
    MAX_VALUE,
    criterion_blocks,
    points_text,
    replay_lines,
)
from tests.cases import every_case


def judged(
    status: CriterionStatus = CriterionStatus.PASS, points: float = 1.0, **more: object
) -> CriterionResult:
    return CriterionResult(
        **{"id": "a", "title": "A", "status": status, "points": points, "max_points": 2.0, **more}
    )  # type: ignore[arg-type]  # by name


def result(*tests: CriterionResult) -> GradingResult:
    return GradingResult("reach", "v1", "abc", "0.1", "public", 1, "linux", tests)


@every_case(
    ("given", "kept"),
    [(math.nan, 0.0), (math.inf, 2.0), (-math.inf, 0.0), (-3.0, 0.0), (5.0, 2.0), (1.5, 1.5)],
)
def test_points_stay_between_nothing_and_the_most(given: float, kept: float) -> None:
    assert judged(points=given).points == kept


@pytest.mark.parametrize("most", [math.nan, math.inf, -1.0])
def test_a_maximum_that_is_none_is_nothing(most: float) -> None:
    assert (judged(max_points=most).max_points, judged(max_points=most).points) == (0.0, 0.0)


@pytest.mark.parametrize("status", [CriterionStatus.SKIPPED, CriterionStatus.GRADER_ERROR])
def test_what_was_not_judged_earns_nothing(status: CriterionStatus) -> None:
    assert judged(status, points=2.0).points == 0.0


def test_a_broken_grader_gives_no_grade() -> None:
    broken = result(judged(), judged(CriterionStatus.GRADER_ERROR))
    assert (broken.verdict, broken.points) == (GradingVerdict.BROKEN, None)
    assert (result(judged(), judged()).verdict, result(judged(), judged()).points) == (
        GradingVerdict.PASS,
        2.0,
    )
    assert result(judged(), judged(CriterionStatus.PARTIAL)).verdict is GradingVerdict.FAIL


def test_nothing_judged_is_no_pass() -> None:
    assert result().verdict is GradingVerdict.FAIL
    assert result(judged(CriterionStatus.SKIPPED)).verdict is GradingVerdict.FAIL
    # Skipped for what it depends on: not a pass. Skipped for lack of secrets at a desk: no obstacle.
    assert result(judged(), judged(CriterionStatus.SKIPPED, depends_on="x")).verdict is GradingVerdict.FAIL
    assert result(judged(), judged(CriterionStatus.SKIPPED)).verdict is GradingVerdict.PASS


def test_a_result_survives_json() -> None:
    made = result(
        judged(
            hints=("a", "b"),
            metrics={"m": 0.5},
            episodes=(EpisodeSummary("maze, seed 1", "reached", 20, 1.0),),
        ),
        judged(CriterionStatus.FAIL, visibility=Visibility.HIDDEN, rationale="no"),
    )
    assert GradingResult.from_dict(json.loads(json.dumps(made.as_dict()))) == made


def test_a_hidden_test_tells_a_student_nothing_but_that_it_is_there() -> None:
    secret = judged(
        CriterionStatus.FAIL, visibility=Visibility.HIDDEN, rationale="s3cret", actual="s3cret", log="s3cret"
    )
    shown = json.dumps(result(secret).for_student().as_dict())
    assert "s3cret" not in shown
    assert len(result(secret).for_student().tests) == 1


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
    return lines_of(criterion_blocks(criterion, **more), Page(width=width))  # type: ignore[arg-type]  # by name


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


def test_what_a_program_printed_is_kept_up_to_a_limit() -> None:
    assert len(judged(CriterionStatus.FAIL, log="x" * 100_000).log) == MAX_LOG_LENGTH


def test_values_in_words_say_no_more_than_the_title() -> None:
    text = "\n".join(
        shown(judged(CriterionStatus.FAIL, 0.0, rationale="Why.", expected="sound", actual="not sound"))
    )
    assert "sound" not in text


def test_long_rationales_and_values_are_shortened() -> None:
    told = {"rationale": "why " * 400, "expected": "3 more " * 300, "actual": "2 less " * 300}
    text = " ".join(line.strip() for line in shown(judged(CriterionStatus.FAIL, 0.0, **told)))
    assert text.count("(shortened)") == 3
    assert text.count("why") <= MAX_RATIONALE / 4
    assert text.count("less") <= text.count("more") <= MAX_VALUE / 5
