"""Mounting lasers: one at every place earns nothing, the fewest gold."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

import pytest

from kit.school.game.board import LIT
from kit.school.game.challenge import AnswerError, AnswerSubmission
from kit.school.game.challenge_kinds.devices import DevicesTask, fewest_lasers, naive_lasers
from kit.school.game.challenges import all_challenges
from kit.school.game.medal import Medal

DEVICES = [each for each in all_challenges() if isinstance(each.task, DevicesTask)]


@pytest.mark.parametrize("challenge", DEVICES, ids=lambda each: each.id)
def test_a_laser_at_every_place_earns_nothing_and_the_fewest_gold(challenge, tmp_path: Path) -> None:
    task = challenge.task

    def worth(lasers: Sequence[tuple[int, int]]) -> Medal:
        return challenge.task.judge(
            AnswerSubmission(" ".join(f"{row},{column}" for row, column in lasers), tmp_path)
        ).medal

    best, naive = fewest_lasers(task), naive_lasers(task)
    assert len({len(line) for line in task.grid}) == 1
    assert len(best) + 2 < len(naive)
    assert worth(naive) is Medal.NONE
    assert worth(best) is Medal.GOLD
    assert worth((*best, best[0])) is Medal.SILVER
    assert worth((*best, *best[:1] * 2)) is Medal.BRONZE
    assert worth(best[1:]) is Medal.NONE
    tidy: list[
        tuple[int, int]
    ] = []  # always the laser that sees most of what is left: no gold for the first idea
    while missed := set(task.places) - task.seen_from(tuple(tidy)):
        tidy.append(max(task.floor, key=lambda square: len(missed & task.seen_from((square,)))))
    assert worth(tidy) < Medal.GOLD
    for wrong in ("", "1", "1,1,1", "-1,2", "0,0", "a,b", "99999,1", "1,1 " * 101):
        with pytest.raises(AnswerError):
            challenge.task.judge(AnswerSubmission(wrong, tmp_path))


def test_walls_are_not_seen_through() -> None:
    task = DevicesTask(("#####", "#a#b#", "#...#", "#####"))
    assert not task.sees((1, 1), (1, 3))
    assert task.sees((2, 2), (2, 1))
    assert all(task.sees(a, b) == task.sees(b, a) for a in task.floor for b in task.floor)
    assert len(fewest_lasers(task)) == 1


def test_the_board_mounts_lasers_and_passes_over_walls() -> None:
    task = DevicesTask(("#####", "#a#b#", "#...#", "#####"))
    board = task.board("")
    board.move(1, 0)
    board.mark()
    assert board.answer == "1,3\n", "the cursor passes over the wall"
    assert task.judge(AnswerSubmission(board.answer, Path())).medal is Medal.NONE
    board.mark()
    board.move(-1, 0)
    board.move(0, 1)
    board.mark()
    assert task.board(board.answer).answer == board.answer
    board.undo()
    assert board.answer == ""


@pytest.mark.parametrize("challenge", DEVICES, ids=lambda each: each.id)
def test_the_fewest_lasers_can_be_mounted_by_keys(challenge) -> None:
    lasers = fewest_lasers(challenge.task)
    board = challenge.task.board(" ".join(f"{row},{column}" for row, column in lasers))
    assert board.judgement().medal is Medal.GOLD
    shown = "".join(text for line in board.rows() for text, _ in line)
    assert all(name.upper() in shown or place in lasers for name, place in challenge.task.places.items())


@pytest.mark.parametrize("challenge", DEVICES, ids=lambda each: each.id)
def test_the_square_of_a_letter_that_is_seen_is_lit_as_well(challenge) -> None:
    task = challenge.task
    square = next(each for each in task.floor if task.seen_from((each,)) and each not in task.places.values())
    board = task.board(f"{square[0]},{square[1]}")
    seen = task.seen_from((square,))
    lit = set()
    for parts in board.rows():
        for (text, style), (after, _) in pairwise([*parts, ("", "")]):
            if style == "good" and len(text) == 1 and text.isupper() and after.startswith(LIT):
                lit.add(text.lower())
    under_cursor = {
        text.strip().lower() for parts in board.rows() for text, style in parts if style == "chosen"
    }
    assert lit == seen - under_cursor
