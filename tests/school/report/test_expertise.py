"""Algorithm 4, what it weighs in truth, and what is doubtful about a division."""

from __future__ import annotations

import math
from collections.abc import Sequence
from statistics import mean
from typing import Any

import numpy as np
import pytest

from kit.school.report.expertise import (
    DIVISION_METHODS,
    TOPICS,
    divide_class,
    effective_weights,
    expertise_scores,
)
from kit.school.report.measures import StudentMeasure
from tests.cases import every_case


def score_of(ratings: Sequence[float]) -> float:
    """One student's, by the kit."""
    measures = [
        StudentMeasure(f"q{topic}", topic, np.array([value]))
        for topic, value in zip(TOPICS, ratings, strict=True)
    ]
    found = expertise_scores(measures, {f"q{topic}": topic for topic in TOPICS})
    assert found is not None
    return float(found[0])


def algorithm_4(
    robotics: float, ros1: float, ros2: float, simulators: float, flatland: float, rl: float
) -> float:
    """Line by line as the dissertation prints it."""
    overall = mean((robotics, ros1, ros2, simulators, flatland, rl))
    ros = max(ros1, ros2)
    robotics_ros = mean((ros, robotics))
    return mean((robotics, ros2, flatland, rl, ros, robotics_ros, overall))


def test_the_score_is_the_algorithms() -> None:
    generator = np.random.default_rng(1)
    for _ in range(100):
        ratings = generator.integers(1, 8, 6).tolist()
        assert score_of(ratings) == pytest.approx(algorithm_4(*ratings))


def test_the_weights_make_the_score() -> None:
    weights = dict(effective_weights())
    assert sum(weights.values()) == pytest.approx(1)
    assert [
        round(weights[name], 3)
        for name in ("robotics", "ros", "ros2", "flatland", "rl", "ros1", "simulators")
    ] == [
        0.238,
        0.214,
        0.167,
        0.167,
        0.167,
        0.024,
        0.024,
    ]
    ratings = dict(zip(TOPICS, (5, 6, 2, 3, 7, 1), strict=True))
    ratings["ros"] = max(ratings["ros1"], ratings["ros2"])
    assert sum(weights[name] * value for name, value in ratings.items()) == pytest.approx(
        score_of((5, 6, 2, 3, 7, 1))
    )


@every_case("topic", TOPICS)
def test_who_leaves_one_out_has_no_score(topic: str) -> None:
    assert math.isnan(score_of([math.nan if each == topic else 4 for each in TOPICS]))


def test_without_a_topic_there_are_no_scores() -> None:
    assert expertise_scores([StudentMeasure("a", "robotics", np.ones(3))], {"a": "robotics"}) is None


def division(way: str, *values: float) -> Any:
    return divide_class(np.array(values), way)


def test_the_three_ways() -> None:
    values = (1.0, 6.0, 3.0, 4.0, math.nan)
    assert {
        way: divide_class(np.array(values), way).experts.members.tolist() for way in DIVISION_METHODS
    } == {  # type: ignore[union-attr]  # each way divides these
        "scale": [False, True, False, True, False],
        "half": [False, True, False, True, False],
        "mean": [False, True, False, True, False],
    }
    for way in DIVISION_METHODS:
        assert not division(way, *values).beginners.members[4], "who has no score is in no group"


@pytest.mark.parametrize("way", DIVISION_METHODS)
@pytest.mark.parametrize("values", [(), (3.0,), (math.nan, 3.0), (math.nan, math.nan)])
def test_too_few_cannot_be_divided(way: str, values: tuple[float, ...]) -> None:
    assert divide_class(np.array(values, dtype=np.float64), way) is None


def test_one_group_only_is_no_division() -> None:
    assert division("scale", 1, 2, 3) is None
    assert division("mean", 2, 2, 2) is None


@pytest.mark.parametrize(
    ("values", "way", "words"),
    [
        ((1, 2, 2, 3), "half", "tie"),
        ((1, 2.0, 2.04, 3), "half", "0.04 apart"),
        ((1, 2, 5), "scale", "only 1 expert"),
    ],
)
def test_a_doubtful_division_gets_warnings(values: tuple[float, ...], way: str, words: str) -> None:
    assert any(words in each for each in division(way, *values).warnings)


def test_a_clear_division_gets_no_warnings() -> None:
    assert division("mean", *([1] * 6), *([6] * 6)).warnings == ()
