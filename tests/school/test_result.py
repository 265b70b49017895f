"""The record of a grading run: what it adds up to, what it never lets through."""

from __future__ import annotations

import json
import math

import pytest

from kit.school.result import (
    CriterionResult,
    CriterionStatus,
    EpisodeSummary,
    GradingResult,
    GradingVerdict,
    Visibility,
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
