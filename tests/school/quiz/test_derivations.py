"""Answers that the kit can find are found by it: the right option says what it does, and each wrong one does not."""

from __future__ import annotations

from pathlib import Path

import pytest

from kit.school.quiz.items import QuizItem
from tests.kit_content import kit_bank
from tests.school.quiz.derivations import DERIVATIONS

ITEMS = kit_bank().items
DERIVED = [item for item in ITEMS if item.derivation]


@pytest.mark.long_cases(
    "endless-loop",
    "no-replay-buffer",
    "ppo-without-clipping",
    "no-target-network",
    "who-falls-less",
    "sarsa-with-epsilon-zero",
    "whose-policy-is-better-tested",
    "not-in-install",
    "what-randomisation-costs",
    "variance-of-the-odometry",
    "why-a-limit",
    "which-way-is-taken",
    "a-smaller-alpha",
    "played-again",
    "silent-topic",
)
@pytest.mark.parametrize("item", DERIVED, ids=lambda item: item.id)
def test_the_answer_is_what_the_kit_does(item: QuizItem, tmp_path: Path) -> None:
    finding = DERIVATIONS[item.derivation](item, tmp_path)
    for option in item.options:
        says_so = finding.means[option.text] == finding.truth
        assert says_so is option.is_right, (option.text, finding)


def test_every_derivation_is_of_use() -> None:
    assert set(DERIVATIONS) == {item.derivation for item in DERIVED}


def test_most_answers_are_derived() -> None:
    assert len(DERIVED) >= 30
    assert len(DERIVED) / len(ITEMS) > 0.8
    by_idea = {item.idea: item for item in ITEMS if item.idea}
    assert sum(bool(item.derivation) for item in by_idea.values()) >= 10
