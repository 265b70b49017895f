"""Dots: one pace for every flow, never too many, and gone when nothing is said."""

from __future__ import annotations

from kit.render.graph import FRAMES_PER_LEG, MAX_DOTS, GraphCell, GraphDrawing, GraphLink, MessageAnimation
from kit.render.graph_data import GraphData
from kit.render.graph_layout import arrange_graph
from kit.ros.graph.snapshot import FlowStats, MessageFlow
from tests.render.conversations import MAZE, WORLD, item, talk

SCAN = MessageFlow(WORLD, "/static_laser")


def said(**counts: int) -> dict[MessageFlow, FlowStats]:
    flows = {
        "scan": SCAN,
        "odom": MessageFlow(WORLD, "/odom"),
        "asked": MessageFlow("/random_walk", "/move_model", is_service=True),
        "answered": MessageFlow(WORLD, "/move_model", is_service=True, response_to="/random_walk"),
        "gone": MessageFlow("/gone", "/cmd_vel"),
    }
    return {flows[name]: FlowStats(count, None) for name, count in counts.items()}


def started(shown: GraphData = MAZE) -> tuple[MessageAnimation, GraphDrawing]:
    travel = MessageAnimation()
    travel.update_counts({})
    return travel, GraphDrawing(shown, arrange_graph(shown), 80)


def way(travel: MessageAnimation, plan: GraphDrawing) -> list[frozenset[GraphCell]]:
    """Where the dots are, frame by frame, until all have arrived."""
    frames = []
    while travel.is_active:
        travel.advance(plan.graph)
        frames.append(travel.cells(plan))
    return [cells for cells in frames if cells]


def test_a_message_goes_from_the_node_to_the_topic_and_on_to_who_listens() -> None:
    travel, plan = started()
    travel.update_counts(said(scan=1))
    frames = way(travel, plan)
    assert len(frames) == 2 * FRAMES_PER_LEG
    first, then = (plan.link_cells(link) for link in plan.routes if link.item == "/static_laser")
    assert all(cells <= set(first) for cells in frames[:FRAMES_PER_LEG])
    assert all(cells <= set(then) for cells in frames[FRAMES_PER_LEG:])
    columns = [cell.column for cells in frames for cell in cells]
    assert columns == sorted(columns)
    assert not travel.is_active


def test_to_nobody_it_ends_at_the_topic() -> None:
    travel, plan = started()
    travel.update_counts(said(odom=1))
    assert len(way(travel, plan)) == FRAMES_PER_LEG


def test_what_was_said_before_is_over() -> None:
    travel = MessageAnimation()
    travel.update_counts(said(scan=1000))
    assert not travel.is_active
    travel.update_counts(said(scan=1000))
    assert not travel.is_active


def test_a_thousand_messages_look_like_ten() -> None:
    travel, plan = started()
    most = 0
    for count in range(60):
        travel.update_counts(said(scan=1000 * count))
        travel.advance(plan.graph)
        most = max(most, len(travel.cells(plan)))
    assert most == 2  # one before the topic, one behind it
    assert len(way(travel, plan)) <= 3 * FRAMES_PER_LEG


def test_an_answer_goes_back_to_who_has_asked() -> None:
    travel, plan = started()
    travel.update_counts(said(answered=1))
    frames = way(travel, plan)
    columns = [cell.column for cells in frames for cell in cells]
    assert len(frames) == 2 * FRAMES_PER_LEG
    assert columns == sorted(columns, reverse=True)


def test_nothing_arrives_over_a_broken_line() -> None:
    shown = talk(item("/scan", "/robot", "/good /bad", ("/robot", "/bad")))
    travel, plan = started(shown)
    travel.update_counts({MessageFlow("/robot", "/scan"): FlowStats(1, None)})
    seen = frozenset().union(*way(travel, plan))
    good, bad = (
        set(plan.link_cells(GraphLink(node, "/scan", is_sender=False))) for node in ("/good", "/bad")
    )
    assert seen & good
    assert not seen & (bad - good)


def test_what_is_not_drawn_does_not_move() -> None:
    travel, plan = started()
    travel.update_counts(said(gone=1))
    assert way(travel, plan) == []


def test_a_dot_whose_line_goes_away_goes_too() -> None:
    travel, plan = started()
    travel.update_counts(said(scan=1))
    travel.advance(plan.graph)
    assert travel.cells(plan)
    rest = GraphData(MAZE.nodes, MAZE.items[:1])
    assert not travel.cells(GraphDrawing(rest, arrange_graph(rest), 80))


def test_there_are_never_more_than_can_be_followed() -> None:
    shown = talk(*(item(f"/topic{number}", "/talker", "") for number in range(40)))
    travel, plan = started(shown)
    travel.update_counts(
        {MessageFlow("/talker", f"/topic{number}"): FlowStats(1, None) for number in range(40)}
    )
    frames = way(travel, plan)
    assert max(map(len, frames)) == MAX_DOTS
    assert frozenset(cell.row for cells in frames for cell in cells) == set(range(40))
