"""Driving blind: certainty is what counts, the fewest moves earn gold, two places after another nothing."""

from __future__ import annotations

from itertools import product
from pathlib import Path

import pytest

from kit.school.game.board import MOVES, find_cell
from kit.school.game.challenge import AnswerSubmission
from kit.school.game.challenge_kinds.blind import BlindTask, fewest_moves, naive_moves, possible_cells
from kit.school.game.challenges import all_challenges
from kit.school.game.medal import Medal

BLINDS = [each for each in all_challenges() if isinstance(each.task, BlindTask)]


@pytest.mark.parametrize("challenge", BLINDS, ids=lambda each: each.id)
def test_certainty_with_the_fewest_moves_earns_gold(challenge) -> None:
    task = challenge.task

    def worth(moves: str) -> Medal:
        return task.judge(AnswerSubmission(moves, Path())).medal

    best = fewest_moves(task)
    assert possible_cells(task, best) == {find_cell(task.grid, "G")}
    assert worth(best) is Medal.GOLD
    assert worth(best[:-1]) is Medal.NONE
    assert worth(naive_moves(task)) is Medal.NONE
    assert possible_cells(task, naive_moves(task)) == {find_cell(task.grid, "G")}, "it does what is asked"
    assert len(best) + 2 < len(naive_moves(task))


def test_no_shorter_moves_do_it() -> None:
    task = BlindTask(("#####", "#...#", "#.#G#", "#####"))
    best = fewest_moves(task)
    goal = {find_cell(task.grid, "G")}
    assert possible_cells(task, best) == goal
    for length in range(len(best)):
        assert not any(
            possible_cells(task, "".join(moves)) == goal for moves in product(MOVES, repeat=length)
        )
