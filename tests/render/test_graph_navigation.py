"""The arrow keys in the picture of a conversation."""

from __future__ import annotations

from kit.render.graph_data import GraphData
from kit.render.graph_drawing import GraphDrawing, GraphElement
from kit.render.graph_layout import arrange_graph
from kit.render.graph_selection import initial_selection, kept_selection, move_horizontally, move_vertically
from tests.render.conversations import DOZEN, MAZE, WORLD


def plan(shown: GraphData = MAZE) -> GraphDrawing:
    return GraphDrawing(shown, arrange_graph(shown), 80)


def test_what_is_wrong_is_looked_at_first() -> None:
    assert initial_selection(plan(DOZEN)) == GraphElement("item", "/r2/scan")
    assert initial_selection(plan()) == GraphElement("item", "/collisions")
    assert initial_selection(plan(GraphData(("/silent",), ()))) == GraphElement("sender", "/silent")
    assert initial_selection(plan(GraphData((), ()))) is None


def test_up_and_down_stay_in_the_column_and_end_at_its_ends() -> None:
    walked = plan()
    spot = GraphElement("item", "/collisions")
    assert move_vertically(walked, spot, -1) == spot
    below = move_vertically(walked, spot, 1)
    assert below.column == "item"
    assert walked.element_rows()[below] == 1
    assert move_vertically(walked, spot, 100) == move_vertically(walked, spot, 5)


def test_left_and_right_follow_the_lines() -> None:
    walked = plan()
    assert move_horizontally(walked, GraphElement("item", "/static_laser"), 1) == GraphElement(
        "receiver", "/random_walk"
    )
    assert move_horizontally(walked, GraphElement("item", "/teleopkeys"), -1) == GraphElement(
        "sender", "/keys"
    )
    assert move_horizontally(walked, GraphElement("sender", "/random_walk"), 1) == GraphElement(
        "item", "/cmd_vel"
    )
    assert move_horizontally(walked, GraphElement("receiver", WORLD), 1) == GraphElement("receiver", WORLD)


def test_a_choice_that_has_gone_is_replaced_by_its_neighbour() -> None:
    spot = GraphElement("item", "/odom")
    row = plan().element_rows()[spot]
    assert kept_selection(plan(), spot, row) == spot
    rest = GraphData(MAZE.nodes, tuple(each for each in MAZE.items if each.label != spot.name))
    left = GraphDrawing(rest, arrange_graph(rest, plan().layout), 80)
    other = kept_selection(left, spot, row)
    assert other is not None
    assert other.column == "item"
    assert abs(left.element_rows()[other] - row) == 1
    assert kept_selection(plan(GraphData((), ())), spot, row) is None
