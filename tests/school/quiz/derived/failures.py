"""Answers on trainings that fail and on tables of figures, by the references of the lessons' exercises and by counting."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from kit.school.quiz.items import QuizItem
from tests.kit_content import lesson_reference
from tests.school.quiz.derived.finding import Derivation, Finding, nearest

FAILING, TABLES = "27-why-a-training-fails", "28-a-papers-table"


def values_above_a_limit(item: QuizItem, folder: Path) -> Finding:
    middle, best, low = lesson_reference(FAILING, "chances").limited([620.0, 700.0, 480.0], 10.0, 500.0)
    truth = "third" if middle == best == low else "alike" if middle == best > low else "never"
    return Finding(
        truth,
        {
            "As often as the one worth 700": "alike",
            "Nearly never, since 700 is so much larger": "never",
            "A third of the time, as each of them": "third",
        },
    )


def worth_of_a_wage(item: QuizItem, folder: Path) -> Finding:
    return nearest(item, sum(2 * 0.95**number for number in range(5_000)), 0.01)


def standing_or_arriving(item: QuizItem, folder: Path) -> Finding:
    """What each way earns, added up."""
    earned = {"soon": 20 * 1 + 100, "late": 200 * 1 + 100, "never": 200 * 1}
    return Finding(
        max(earned, key=lambda name: earned[name]),
        {
            "It arrives as soon as it can": "soon",
            "It arrives in the last step": "late",
            "It never arrives at all": "never",
        },
    )


def the_best_of_sixty(item: QuizItem, folder: Path) -> Finding:
    drawn = np.random.default_rng(3).binomial(100, 0.5, (20_000, 60)).max(axis=1) / 100
    return nearest(item, float(drawn.mean()), 0.01)


def why_the_largest_is_taken_away(item: QuizItem, folder: Path) -> Finding:
    """Against the chances by the definition, with exponentials that do not overflow yet."""
    found = lesson_reference(FAILING, "chances").chances([3000.0, 2990.0], 10.0)
    plain = np.exp(np.array([300.0, 299.0]))
    is_same = np.allclose(found, plain / plain.sum())
    return Finding(
        "same" if is_same else "equal" if found[0] == found[1] else "overflow",
        {
            "They stay just as they were": "same",
            "Both moves become equally likely": "equal",
            "They overflow, as they did before": "overflow",
        },
    )


def report_of_the_best(item: QuizItem, folder: Path) -> Finding:
    tests, exams = [[60, 100], [77, 100], [50, 100]], [[55, 100], [64, 100], [80, 100]]
    _, share, _ = lesson_reference(TABLES, "best").report(tests, exams)
    return nearest(item, share, 0.001)


def two_rows(item: QuizItem, folder: Path) -> Finding:
    claim = lesson_reference(TABLES, "honest").claim([0.79, 0.64, 0.93], [0.93, 0.87, 0.99])
    return Finding(claim, {"The first one": "better", "The second one": "worse", "Neither of them": "open"})


def seeds_and_width(item: QuizItem, folder: Path) -> Finding:
    _, low, high = lesson_reference(TABLES, "honest").row([0.9, 0.8])
    found = f"From {low:.2f} to {high:.2f}"
    return Finding(found, {option.text: option.text for option in item.options})


def adjacency_of_crashes(item: QuizItem, folder: Path) -> Finding:
    found = lesson_reference(TABLES, "honest").beside([[False, 0.97]] * 5)
    return Finding(
        found,
        {
            "0.97, since it was measured": 0.97,
            "0, since they did not arrive": 0.0,
            "No figure in that place": None,
        },
    )


FAILURES: dict[str, Derivation] = {
    "values-above-a-limit": values_above_a_limit,
    "worth-of-a-wage": worth_of_a_wage,
    "standing-or-arriving": standing_or_arriving,
    "the-best-of-sixty": the_best_of_sixty,
    "why-the-largest-is-taken-away": why_the_largest_is_taken_away,
    "report-of-the-best": report_of_the_best,
    "two-rows": two_rows,
    "seeds-and-width": seeds_and_width,
    "adjacency-of-crashes": adjacency_of_crashes,
}
