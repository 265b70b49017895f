"""Moves, how fast they are, and how two robots' moves are chosen at once."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from kit.learning.environment.actions import FOUR_MOVES, SEVEN_MOVES, THREE_MOVES, Actions, Move

every_one = pytest.mark.parametrize("actions", [THREE_MOVES, FOUR_MOVES, SEVEN_MOVES])


@every_one
def test_a_move_is_what_its_name_says(actions: Actions) -> None:
    for move, (forward, turn) in zip(actions.moves, actions.twists.tolist(), strict=True):
        assert np.sign(forward) == ("FORWARD" in move.name) - ("BACK" in move.name)
        assert np.sign(turn) == ("LEFT" in move.name) - ("RIGHT" in move.name)
        assert abs(forward) in (0.0, actions.speed)
        assert abs(turn) in (0.0, actions.turn_rate)
    assert [Move(code) for code in actions.move_codes.tolist()] == list(actions.moves)


@every_one
def test_one_number_or_two_choose_the_same(actions: Actions) -> None:
    count = len(actions.moves)
    apart = replace(actions, one_number=False)
    assert actions.space(2).n == count**2
    assert apart.space(2).nvec.tolist() == [count, count]
    pairs = np.array([(one, other) for one in range(count) for other in range(count)])
    assert np.array_equal(apart.decode(pairs, 2), pairs)
    assert np.array_equal(actions.decode(np.arange(count**2), 2), pairs)


@every_one
def test_one_robot_takes_numbers(actions: Actions) -> None:
    count = len(actions.moves)
    for each in (actions, replace(actions, one_number=False)):
        assert each.space(1).n == count
        assert each.decode(np.arange(count), 1).tolist() == [[i] for i in range(count)]


@pytest.mark.parametrize("wrong", [[16], [-1], [0, 99]])
def test_what_is_not_in_the_space_is_refused(wrong: list[int]) -> None:
    with pytest.raises(ValueError, match="outside Discrete"):
        FOUR_MOVES.decode(np.array(wrong), 2)
