"""Tuning Q-learning: the numbers it is usually begun with earn nothing, some others gold, and it is no matter of luck."""

from __future__ import annotations

from pathlib import Path

import pytest

from kit.school.game.challenge import AnswerError, AnswerSubmission
from kit.school.game.challenge_kinds.tuning import CHOICES, NAIVE, TuningTask, format_numbers, learn
from kit.school.game.challenges import all_challenges
from kit.school.game.medal import Medal

TUNINGS = [each for each in all_challenges() if isinstance(each.task, TuningTask)]
GOOD = {"rate": 1.0, "exploration": 0.1, "discount": 0.9, "first_value": 0.25, "episodes": 20}


@pytest.mark.parametrize("challenge", TUNINGS, ids=lambda each: each.id)
def test_numbers_that_suit_the_grid_earn_gold(challenge) -> None:
    task = challenge.task

    def worth(numbers: dict[str, float]) -> Medal:
        return task.judge(AnswerSubmission(format_numbers(numbers), Path())).medal

    assert worth(NAIVE) is Medal.NONE
    assert worth(GOOD) is Medal.GOLD
    assert worth({**GOOD, "episodes": 5}) is Medal.NONE, "too little to learn it"
    assert worth({**GOOD, "episodes": 160}) < Medal.GOLD, "the budget counts"
    assert worth({**GOOD, "rate": 0.01}) is Medal.NONE
    for wrong in ("", "rate=0.1", format_numbers(GOOD) + "speed=1", format_numbers({**GOOD, "rate": 0.2})):
        with pytest.raises(AnswerError):
            task.judge(AnswerSubmission(wrong, Path()))


def test_the_same_numbers_learn_the_same() -> None:
    (challenge, *_) = TUNINGS
    numbers = tuple(GOOD[name] for name in CHOICES)
    first = learn(challenge.task, numbers)
    learn.cache_clear()
    assert learn(challenge.task, numbers) == first
    assert len(first.curve) == GOOD["episodes"]


def test_the_board_moves_sliders_within_their_ends() -> None:
    (challenge, *_) = TUNINGS
    board = challenge.task.board("")
    board.move(10, 0)
    assert f"rate={CHOICES['rate'][-1]:g}" in board.answer
    board.undo()
    assert board.answer == format_numbers(NAIVE)
    board.move(0, 1)
    board.move(-10, 0)
    assert f"exploration={CHOICES['exploration'][0]:g}" in board.answer
