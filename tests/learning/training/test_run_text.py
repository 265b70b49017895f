"""What happens in runs as text."""

from __future__ import annotations

import math

from kit.document.layout import lines_of
from kit.learning.policies.evaluation import CaseResult, EvaluationResult
from kit.learning.training.run_text import comparison_tables


def result(**cases: tuple[int, float]) -> EvaluationResult:
    """Of ten episodes in each case, so many that arrived; and the adjacency."""
    found = (
        CaseResult(name, "", (reached, 10 - reached, 0), 50.0, 1.0, adjacency)
        for name, (reached, adjacency) in cases.items()
    )
    return EvaluationResult("task", greedy=True, cases=tuple(found))


def test_policies_for_one_robot_are_compared_by_success_alone() -> None:
    rows = lines_of(
        comparison_tables(
            {"a": result(left=(9, math.nan), right=(5, math.nan)), "b": result(right=(8, math.nan))}
        )
    )
    assert [row.split() for row in rows] == [
        ["case", "a", "b"],
        ["left", "0.900"],
        ["right", "0.500", "0.800"],
        ["mean", "0.700", "0.800"],
        ["worst", "0.500", "0.800"],
    ]


def test_those_for_two_robots_by_their_adjacency_too() -> None:
    rows = lines_of(
        comparison_tables(
            {"pair": result(left=(9, 0.25), right=(5, 0.75)), "one": result(left=(3, math.nan))}
        )
    )
    success, adjacency = rows[: rows.index("")], rows[rows.index("") + 1 :]
    assert "one" in success[0]
    assert [row.split() for row in adjacency] == [
        ["adj", "rays", "pair"],
        ["left", "0.250"],
        ["right", "0.750"],
        ["mean", "0.500"],
    ]
