"""The arrow keys in the picture of a conversation."""

from __future__ import annotations

from kit.render.graph import Plan, Spot
from kit.render.graph_data import Conversation
from kit.render.graph_layout import arrange
from kit.render.graph_navigation import across, along, first_choice, still_there
from tests.render.conversations import DOZEN, MAZE, WORLD


def plan(shown: Conversation = MAZE) -> Plan:
    return Plan(shown, arrange(shown), 80)


def test_what_is_wrong_is_looked_at_first() -> None:
    assert first_choice(plan(DOZEN)) == Spot("item", "/r2/scan")
    assert first_choice(plan()) == Spot("item", "/collisions")
    assert first_choice(plan(Conversation(("/silent",), ()))) == Spot("sender", "/silent")
    assert first_choice(plan(Conversation((), ()))) is None


def test_up_and_down_stay_in_the_column_and_end_at_its_ends() -> None:
    walked = plan()
    spot = Spot("item", "/collisions")
    assert along(walked, spot, -1) == spot
    below = along(walked, spot, 1)
    assert below.column == "item"
    assert walked.spots()[below] == 1
    assert along(walked, spot, 100) == along(walked, spot, 5)


def test_left_and_right_follow_the_lines() -> None:
    walked = plan()
    assert across(walked, Spot("item", "/static_laser"), 1) == Spot("receiver", "/random_walk")
    assert across(walked, Spot("item", "/teleopkeys"), -1) == Spot("sender", "/keys")
    assert across(walked, Spot("sender", "/random_walk"), 1) == Spot("item", "/cmd_vel")
    assert across(walked, Spot("receiver", WORLD), 1) == Spot("receiver", WORLD)


def test_a_choice_that_has_gone_is_replaced_by_its_neighbour() -> None:
    spot = Spot("item", "/odom")
    row = plan().spots()[spot]
    assert still_there(plan(), spot, row) == spot
    rest = Conversation(MAZE.nodes, tuple(each for each in MAZE.items if each.label != spot.name))
    left = Plan(rest, arrange(rest, plan().places), 80)
    other = still_there(left, spot, row)
    assert other is not None
    assert other.column == "item"
    assert abs(left.spots()[other] - row) == 1
    assert still_there(plan(Conversation((), ())), spot, row) is None
