"""A round: in the order of the letters it earns nothing, the shortest gold, and a nearest-first walk is not the shortest."""

from __future__ import annotations

from itertools import pairwise, permutations
from pathlib import Path

import pytest

from kit.school.game.board import find_cell, shortest_way
from kit.school.game.challenge import AnswerSubmission
from kit.school.game.challenge_kinds.round import RoundTask, best_round, naive_round
from kit.school.game.challenges import all_challenges
from kit.school.game.medal import Medal

ROUNDS = [each for each in all_challenges() if isinstance(each.task, RoundTask)]


def worth(task: RoundTask, moves: str) -> Medal:
    return task.judge(AnswerSubmission(moves, Path())).medal


@pytest.mark.parametrize("challenge", ROUNDS, ids=lambda each: each.id)
def test_the_shortest_round_earns_gold_and_the_list_nothing(challenge) -> None:
    task = challenge.task
    best = best_round(task)
    assert worth(task, naive_round(task)) is Medal.NONE
    assert worth(task, best) is Medal.GOLD
    assert worth(task, best[:1] * 2 + best) <= Medal.SILVER
    assert worth(task, best[:-1]) is Medal.NONE, "home is part of it"
    assert worth(task, "") is Medal.NONE
    cell, left, moves = find_cell(task.grid, "S"), dict(task.places), ""
    while left:  # the nearest one first
        name = min(left, key=lambda each: len(shortest_way(task.grid, cell, left[each])))
        moves += shortest_way(task.grid, cell, left[name])
        cell = left.pop(name)
    moves += shortest_way(task.grid, cell, find_cell(task.grid, "S"))
    assert worth(task, moves) < Medal.GOLD


def test_no_order_is_shorter_than_the_best_one() -> None:
    task = RoundTask(("#######", "#a.S.b#", "#.###.#", "#c...d#", "#######"))
    home = find_cell(task.grid, "S")

    def length(order: tuple[str, ...]) -> int:
        stops = [home, *(task.places[name] for name in order), home]
        return sum(len(shortest_way(task.grid, a, b)) for a, b in pairwise(stops))

    assert len(best_round(task)) == min(map(length, permutations("abcd")))


def test_the_board_walks_and_takes_back() -> None:
    (challenge, *_) = ROUNDS
    board = challenge.task.board("")
    for columns, rows in ((1, 0), (0, 1), (0, 10)):
        board.move(columns, rows)
    assert board.answer.strip() == "rd"
    board.undo()
    assert board.answer.strip() == "r"
    assert challenge.task.board("rrd").answer.strip() == "rrd"
    assert challenge.task.board(challenge.task.naive_answer()).answer.strip() == ""
