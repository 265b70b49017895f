"""Passing by: own shortest ways meet, the plan that is over first earns gold, and changing places counts as a meeting."""

from __future__ import annotations

from pathlib import Path

import pytest

from kit.school.game.challenge import AnswerError, AnswerSubmission
from kit.school.game.challenge_kinds.pass_by import PassByTask, fewest_ticks, first_meeting, read_two
from kit.school.game.challenges import all_challenges
from kit.school.game.medal import Medal

PASSAGES = [each for each in all_challenges() if isinstance(each.task, PassByTask)]


@pytest.mark.parametrize("challenge", PASSAGES, ids=lambda each: each.id)
def test_the_earliest_plan_earns_gold_and_own_ways_meet(challenge) -> None:
    task = challenge.task

    def worth(*moves: str) -> Medal:
        return task.judge(AnswerSubmission(" ".join(moves), Path())).medal

    best = fewest_ticks(task)
    assert worth(*best) is Medal.GOLD
    assert worth(*(f".{own}" for own in best)) is Medal.SILVER
    assert worth(*(f"...{own}" for own in best)) is Medal.BRONZE
    assert worth(*task.naive_answer().split()) is Medal.NONE
    assert first_meeting(task, read_two(task.naive_answer())) > 0
    assert worth(".", ".") is Medal.NONE
    for wrong in ("l", "l r u", "x l", "l" * 101 + " r"):
        with pytest.raises(AnswerError):
            worth(wrong)


def test_robots_that_change_places_meet() -> None:
    task = PassByTask(("######", "#ABba#", "######"))
    assert first_meeting(task, ("r", "l")) == 1
    assert first_meeting(task, ("r", ".")) == 1
    assert first_meeting(task, ("r", "r")) == 0
    assert first_meeting(task, ("rr", "r.")) == 2


def test_the_board_plans_both_robots() -> None:
    (challenge, *_) = PASSAGES
    board = challenge.task.board("")
    board.move(1, 0)
    board.mark()
    board.switch()
    board.move(-1, 0)
    assert board.answer.split() == ["r.", "l"]
    board.undo()
    board.undo()
    assert board.answer.split() == ["r.", "."]
