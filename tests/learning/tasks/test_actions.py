"""Moves, how fast they are, and how two robots' moves are chosen at once."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from kit.learning.tasks.actions import ContinuousActions, DiscreteActions, Move
from tests.learning.worlds import FOUR_MOVES, SEVEN_MOVES, THREE_MOVES

every_one = pytest.mark.parametrize("actions", [THREE_MOVES, FOUR_MOVES, SEVEN_MOVES])


@every_one
def test_a_move_is_what_its_name_says(actions: DiscreteActions) -> None:
    for move, (forward, turn) in zip(actions.moves, actions.twists.tolist(), strict=True):
        assert np.sign(forward) == ("FORWARD" in move.name) - ("BACK" in move.name)
        assert np.sign(turn) == ("LEFT" in move.name) - ("RIGHT" in move.name)
        assert abs(forward) in (0.0, actions.largest[0])
        assert abs(turn) in (0.0, actions.largest[1])
    assert [move.name.lower() for move in actions.moves] == list(actions.names)


@every_one
def test_one_number_or_two_choose_the_same(actions: DiscreteActions) -> None:
    count = len(actions.moves)
    apart = replace(actions, one_number=False)
    assert actions.space(2).n == count**2
    assert apart.space(2).nvec.tolist() == [count, count]
    pairs = np.array([(one, other) for one in range(count) for other in range(count)])
    assert np.array_equal(apart.decode(pairs, 2), pairs)
    assert np.array_equal(actions.decode(np.arange(count**2), 2), pairs)


@every_one
def test_one_robot_takes_numbers(actions: DiscreteActions) -> None:
    count = len(actions.moves)
    for each in (actions, replace(actions, one_number=False)):
        assert each.space(1).n == count
        assert each.decode(np.arange(count), 1).tolist() == [[i] for i in range(count)]


@pytest.mark.parametrize("wrong", [[16], [-1], [0, 99]])
def test_what_is_not_in_the_space_is_refused(wrong: list[int]) -> None:
    with pytest.raises(ValueError, match="outside Discrete"):
        FOUR_MOVES.decode(np.array(wrong), 2)


@every_one
@pytest.mark.parametrize("robots", [1, 2, 3, 4])
def test_one_number_stands_for_the_choices_of_all_robots(actions: DiscreteActions, robots: int) -> None:
    numbers = np.arange(actions.space(robots).n)
    choices = actions.decode(numbers, robots)
    assert len(np.unique(choices, axis=0)) == len(actions.names) ** robots
    assert np.array_equal(actions.encode(choices, robots), numbers)


CONTINUOUS = ContinuousActions((-0.1, 0.5), (-2.0, 2.0))


def test_any_twist_between_the_bounds() -> None:
    space = CONTINUOUS.space(2)
    assert space.shape == (4,)
    commands = CONTINUOUS.commands(np.array([[-1.0, 0.0, 1.0, -1.0], [9.0, -9.0, 0.0, 0.5]]), 2)
    assert commands.twists[0] == pytest.approx(np.array([[-0.1, 0.0], [0.5, -2.0]]))
    assert commands.twists[1] == pytest.approx(np.array([[0.5, -2.0], [0.2, 1.0]]))
    assert commands.moves.tolist() == [
        [Move.BACK, Move.FORWARD_RIGHT],
        [Move.FORWARD_RIGHT, Move.FORWARD_LEFT],
    ]


def test_the_mirror_image_of_a_twist_turns_the_other_way() -> None:
    actions = np.array([[0.2, 0.7, -0.4, 0.1]], dtype=np.float32)
    straight, mirrored = (
        CONTINUOUS.commands(each, 2).twists for each in (actions, CONTINUOUS.mirror(actions, 2))
    )
    assert mirrored == pytest.approx(straight[:, ::-1] * [1.0, -1.0], abs=1e-6)
    with pytest.raises(ValueError, match="not symmetric"):
        ContinuousActions((0.0, 1.0), (-1.0, 2.0)).mirror(actions, 2)


def test_an_action_that_is_no_number_is_refused() -> None:
    with pytest.raises(ValueError, match="finite"):
        CONTINUOUS.commands(np.array([[np.nan, 0.0]]), 1)
