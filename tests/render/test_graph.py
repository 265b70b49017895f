"""A conversation in characters: golden pictures, and what must hold of every one."""

from __future__ import annotations

from itertools import pairwise

import pytest

from kit.render.encode import Frame
from kit.render.graph import MESSAGE_ROLE, MISMATCH_ROLE, SELECTED_ROLE, GraphView, draw_graph, rate_text
from kit.render.graph_data import GraphData
from kit.render.graph_drawing import GraphCell, GraphDrawing, GraphElement, GraphLink
from kit.render.graph_glyphs import ASCII_LINES
from kit.render.graph_layout import arrange_graph
from kit.render.message_animation import FRAMES_PER_LEG, MAX_DOTS, MessageAnimation
from kit.ros.graph.topic_statistics import FlowStats, MessageFlow
from tests.cases import every_case
from tests.render.conversations import DOZEN, MAZE, WORLD, item, talk


def plan(shown: GraphData, width: int = 80) -> GraphDrawing:
    return GraphDrawing(shown, arrange_graph(shown), width)


def picture(shown: GraphData, sight: GraphView | None = None, width: int = 80) -> Frame:
    laid_out = plan(shown, width)
    return draw_graph(laid_out, sight or GraphView(), laid_out.layout.height)


def test_the_maze() -> None:
    sight = GraphView({"/static_laser": 10.0, "/cmd_vel": 9.96}, GraphElement("item", "/static_laser"))
    assert picture(MAZE, sight).rows() == [
        " /flatland_server ┓────────────▶  /collisions ─────────────┏▶  /random_walk",
        "                  ┃────────────▶  /odom                    ┃",
        "                  ┗━━━━━━10 Hz━▶ [/static_laser]━━━━━━━━━━━┛",
        " /random_walk ────┬──────10 Hz─▶  /cmd_vel ────────────────┬▶  /flatland_server",
        "                  └╌╌╌╌╌╌╌╌╌╌╌╌▶  /move_model() ╌╌╌╌╌╌╌╌╌╌╌┘",
        " /keys ────────────────────────▶  /teleopkeys",
    ]


def test_in_plain_characters() -> None:
    shown = talk(item("/scan", "/robot", "/a /b", ("/robot", "/b")), item("/ask()", "/a", "/robot"))
    laid_out = plan(shown, 60)
    rows = draw_graph(
        laid_out, GraphView(selected=GraphElement("sender", "/a")), laid_out.layout.height, ASCII_LINES
    ).rows()
    assert rows == [
        " /robot ---------------->  /scan =============X> [/a]",
        "                                              +>  /b",
        "[/a]====================>  /ask() .............>  /robot",
    ]


def test_a_dozen_nodes_at_eighty_columns_keep_their_names() -> None:
    text = "\n".join(picture(DOZEN).rows())
    assert max(map(len, text.splitlines())) <= 80
    for name in (*DOZEN.nodes, *(each.label for each in DOZEN.items)):
        assert f" {name}" in text
    assert text.count("✗") == 1


@pytest.mark.parametrize("width", [40, 60, 80, 132])
@pytest.mark.parametrize("shown", [MAZE, DOZEN, GraphData((), ())], ids=["maze", "dozen", "nobody"])
def test_every_width_has_room_for_something(shown: GraphData, width: int) -> None:
    laid_out = plan(shown, width)
    frame = draw_graph(laid_out, GraphView(), 10)
    assert frame.shape == (10, width)


def test_what_is_chosen_is_in_brackets_and_its_lines_are_thick() -> None:
    frame = picture(MAZE, GraphView(selected=GraphElement("receiver", "/random_walk")))
    rows = frame.rows()
    text = "\n".join(rows)
    assert text.count("[/random_walk]") == 2  # as a sender and as a receiver
    assert "━━▶  /cmd_vel ─" in text
    assert "/static_laser ━━" in text
    to_odom = next(line.partition("/odom")[0] for line in rows if "/odom" in line)
    assert not set(to_odom) & set("━┃┏┓┗┛┣┫")
    assert SELECTED_ROLE in frame.fg
    assert SELECTED_ROLE not in picture(MAZE).fg


def test_a_broken_line_is_marked_where_it_leaves_the_common_one() -> None:
    shown = talk(item("/scan", WORLD, "/good /bad", (WORLD, "/bad")))
    frame = picture(shown)
    marks = [(row, line.index("✗")) for row, line in enumerate(frame.rows()) if "✗" in line]
    joint = plan(shown).routes[GraphLink("/bad", "/scan", is_sender=False)].branch_cell
    assert marks == [(joint.row, joint.column)]
    assert frame.fg[marks[0]] == MISMATCH_ROLE


def test_messages_are_dots_on_the_lines_and_hide_no_word() -> None:
    laid_out = plan(MAZE)
    path = laid_out.link_cells(GraphLink(WORLD, "/static_laser", is_sender=True))
    without = draw_graph(laid_out, GraphView({"/static_laser": 100.0}), laid_out.layout.height)
    shown = 0
    for cell in path:
        frame = draw_graph(
            laid_out, GraphView({"/static_laser": 100.0}, message_cells={cell}), laid_out.layout.height
        )
        assert "100 Hz" in frame.text(laid_out.layout.items["/static_laser"])
        changed = int((frame.glyphs != without.glyphs).sum())
        assert changed == (chr(frame.glyphs[cell.row, cell.column]) == "●")
        assert (MESSAGE_ROLE in frame.fg) == bool(changed)
        shown += changed
    assert shown == len(path) - len("100 Hz")


def test_a_path_leads_from_the_sender_to_the_receiver_step_by_step() -> None:
    laid_out = plan(DOZEN)
    for link in laid_out.routes:
        path = laid_out.link_cells(link)
        side = laid_out.layout.senders if link.is_sender else laid_out.layout.receivers
        ends = [side.rows[link.node], laid_out.layout.items[link.item]]
        assert [path[0].row, path[-1].row] == (ends if link.is_sender else ends[::-1])
        for one, next_one in pairwise(path):
            assert abs(one.row - next_one.row) + next_one.column - one.column == 1


def test_only_the_rows_from_the_top_on_are_shown() -> None:
    laid_out = plan(DOZEN)
    whole = draw_graph(laid_out, GraphView(), laid_out.layout.height).rows()
    assert (
        draw_graph(laid_out, GraphView(first_row=5, message_cells=[GraphCell(0, 0)]), 4).rows() == whole[5:9]
    )


def test_columns_stay_where_they_are_when_somebody_joins() -> None:
    before = plan(MAZE)
    joined = talk(*MAZE.items, item("/map", "/mapper", "/random_walk /planner"))
    after = GraphDrawing(joined, arrange_graph(joined, before.layout), 80)
    assert after.columns.item_start == before.columns.item_start
    assert after.columns.receiver_start == before.columns.receiver_start
    names = before.element_rows()
    assert {spot: after.element_rows()[spot] for spot in names} == names


@every_case(
    ("rate", "text"),
    [
        (0.2, "0.2 Hz"),
        (0.25, "0.25 Hz"),
        (5.0, "5 Hz"),
        (9.96, "10 Hz"),
        (99.7, "100 Hz"),
        (1234.0, "1.2 kHz"),
    ],
)
def test_rates_are_short(rate: float, text: str) -> None:
    assert rate_text(rate) == text


def test_a_name_is_whole_where_another_column_has_more_than_it_needs() -> None:
    for node, topic in (("/a_node_with_a_name", "/t"), ("/n", "/a_topic_with_a_rather_long_name")):
        shown = picture(talk(item(topic, node, node))).rows()[0]
        assert shown.count(node) == 2
        assert topic in shown
    narrow = picture(talk(item("/static_laser", "/flatland_server", "/controller")), width=72).rows()[0]
    assert "/flatland_server" in narrow, "lanes without a line give way"


def test_long_names_keep_what_tells_them_apart() -> None:
    shown = talk(
        item("/some_robot_of_the_second_floor/get_parameters()", "/a", "/b"),
        item("/some_robot_of_the_second_floor/set_parameters()", "/a", "/b"),
    )
    rows = picture(shown, width=60).rows()
    assert "get_parameters()" in rows[0]
    assert "set_parameters()" in rows[1]
    assert "…" in rows[0]


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
