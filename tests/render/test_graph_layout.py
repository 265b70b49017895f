"""What of a graph is worth showing."""

from __future__ import annotations

import math
from itertools import combinations, pairwise

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from kit.msg.conversion import to_dict
from kit.msg.example_interfaces import Fibonacci
from kit.msg.flatland_msgs import Collision, Collisions
from kit.msg.geometry_msgs import Twist
from kit.msg.message import Message
from kit.msg.sensor_msgs import LaserScan
from kit.msg.std_msgs import Float32, String
from kit.msg.std_srvs import Empty, SetBool, Trigger
from kit.render.graph_data import GraphData, GraphItem, build_graph_data
from kit.render.graph_drawing import GraphDrawing, GraphLink
from kit.render.graph_glyphs import HORIZONTAL, VERTICAL
from kit.render.graph_layout import GraphLayout, arrange_graph
from kit.render.message_rows import MAX_NUMBER_ROWS, message_rows
from kit.ros.action.client import ActionClient
from kit.ros.action.server import ActionServer
from kit.ros.graph.graph import Graph
from kit.ros.graph.snapshot import GraphState, snapshot
from kit.ros.node.node import create_graph_node
from kit.ros.node.qos import qos_profile_sensor_data
from tests.cases import every_case
from tests.render.conversations import DOZEN, MAZE, item, talk


@pytest.fixture
def state() -> GraphState:
    graph = Graph(log_sink=lambda record: None)
    talker, listener = create_graph_node(graph, "talker"), create_graph_node(graph, "listener")
    talker.create_publisher(String, "words", qos_profile_sensor_data)
    listener.create_subscription(String, "words", print, 10)
    listener.create_service(Trigger, "used", lambda request, response: response)
    listener.create_service(Trigger, "unused", lambda request, response: response)
    talker.create_client(Trigger, "used")
    return snapshot(graph)


def test_what_ros_needs_for_itself_and_what_nobody_asks_is_hidden(state: GraphState) -> None:
    shown = build_graph_data(state)
    assert [item.label for item in shown.items] == ["/words", "/used()"]
    assert shown.hidden_count == 1 + 2 * 6 + 2  # a service, parameter services, /rosout and /parameter_events
    everything = build_graph_data(state, show_all=True)
    assert everything.hidden_count == 0
    assert len(everything.items) == 2 + shown.hidden_count


def test_a_line_on_which_nothing_arrives_is_broken(state: GraphState) -> None:
    words = build_graph_data(state).items[0]
    assert words.undelivered == {("/talker", "/listener")}


def test_narrowing_keeps_what_is_joined_to_the_name(state: GraphState) -> None:
    by_topic = build_graph_data(state, name_filter="WORD")
    assert [item.label for item in by_topic.items] == ["/words"]
    assert by_topic.nodes == ("/talker", "/listener")
    assert build_graph_data(state, name_filter="talker").items == build_graph_data(state).items
    assert build_graph_data(state, name_filter="nothing of that name").nodes == ()


def test_a_node_without_anything_to_say_is_there_all_the_same() -> None:
    graph = Graph(log_sink=lambda record: None)
    create_graph_node(graph, "silent")
    assert build_graph_data(snapshot(graph)).nodes == ("/silent",)


def test_an_action_shows_its_goals_results_and_feedback() -> None:
    graph = Graph(log_sink=lambda record: None)
    ActionServer(create_graph_node(graph, "arm"), Fibonacci, "wave", lambda goal_handle: Fibonacci.Result())
    ActionClient(create_graph_node(graph, "brain"), Fibonacci, "wave")
    shown = build_graph_data(snapshot(graph))
    assert [(item.label, item.senders, item.receivers) for item in shown.items] == [
        ("/wave/_action/feedback", ("/arm",), ("/brain",)),
        ("/wave/_action/get_result()", ("/brain",), ("/arm",)),
        ("/wave/_action/send_goal()", ("/brain",), ("/arm",)),
    ]


def twist() -> Twist:
    message = Twist()
    message.linear.x, message.angular.z = 0.5, -1.25
    return message


def test_a_twist_as_ros_echoes_it() -> None:
    assert message_rows(twist(), 80) == [
        "linear:",
        "  x: 0.5",
        "  y: 0.0",
        "  z: 0.0",
        "angular:",
        "  x: 0.0",
        "  y: 0.0",
        "  z: -1.25",
    ]


def test_a_compact_twist_takes_two_rows() -> None:
    assert message_rows(twist(), 80, compact=True) == [
        "linear: {x: 0.5, y: 0.0, z: 0.0}",
        "angular: {x: 0.0, y: 0.0, z: -1.25}",
    ]


@every_case("compact", [False, True])
@every_case(
    "message",
    [
        twist(),
        LaserScan(ranges=[1.5, math.inf, 0.25]),
        String(data="p_up"),
        String(data=""),
        String(data="yes: no # 'maybe'"),
        String(data="true"),
        Float32(data=math.nan),
        SetBool.Request(data=True),
        Empty.Request(),
        Collisions(collisions=[Collision(entity_a="robot", entity_b="wall"), Collision(entity_a="other")]),
    ],
    ids=lambda message: type(message).__name__ if isinstance(message, Message) else str(message),
)
def test_it_is_yaml_of_the_same_values(message: Message, compact: bool) -> None:
    read = yaml.safe_load("\n".join(message_rows(message, 200, compact=compact)))
    assert repr(read) == repr(to_dict(message))


def test_long_lists_are_cut_with_their_length() -> None:
    scan = LaserScan(ranges=[float(number) for number in range(91)])
    rows = message_rows(scan, 60)
    assert max(map(len, rows)) <= 60
    first = next(number for number, row in enumerate(rows) if row.startswith("ranges"))
    ranges = rows[first : first + MAX_NUMBER_ROWS]
    assert ranges[0].startswith("ranges: [0.0, 1.0, ")
    assert ranges[-1].endswith(" ... 91 in all]")
    assert rows[first + MAX_NUMBER_ROWS] == "intensities: []"


@pytest.mark.parametrize("width", [8, 20, 40])
def test_no_row_is_wider_than_asked(width: int) -> None:
    for compact in (False, True):
        assert max(map(len, message_rows(twist(), width, compact=compact))) <= width


NODES = [f"/node{number}" for number in range(8)]
some_nodes = st.lists(st.sampled_from(NODES), max_size=5, unique=True).map(tuple)
some_items = st.dictionaries(
    st.sampled_from([f"/topic{number}" for number in range(9)]), st.tuples(some_nodes, some_nodes), max_size=9
)
conversations = st.tuples(some_items, some_nodes).map(
    lambda drawn: talk(
        *(
            GraphItem(name, name, senders, receivers)
            for name, (senders, receivers) in sorted(drawn[0].items())
        ),
        alone=" ".join(drawn[1]),
    )
)


def assert_sound(shown: GraphData, places: GraphLayout) -> None:
    """Everything has a place of its own, and lines that do not belong together touch nowhere."""
    assert set(places.items) == {each.label for each in shown.items}
    seated = places.senders.rows.keys() | places.receivers.rows.keys()
    assert seated == set(shown.nodes)
    for rows in (places.items, places.senders.rows, places.receivers.rows):
        assert len(set(rows.values())) == len(rows)
    plan = GraphDrawing(shown, places, 80)
    met: dict[object, list[tuple[GraphLink, int]]] = {}
    for link, way in plan.routes.items():
        for cell, leads in way.cells:
            met.setdefault(cell, []).append((link, leads))
    for links in met.values():
        for (one, leads), (other, others) in combinations(links, 2):
            crossing = {leads, others} == {HORIZONTAL, VERTICAL}
            assert crossing or one.node == other.node or one.item == other.item, (one, other)


@pytest.mark.long
@given(conversations)
def test_all_that_talk_have_places_and_their_lines_are_apart(shown: GraphData) -> None:
    assert_sound(shown, arrange_graph(shown))


@pytest.mark.long
@given(st.lists(conversations, min_size=2, max_size=4))
def test_nothing_jumps_when_something_joins_or_leaves(story: list[GraphData]) -> None:
    places = arrange_graph(story[0])
    for before, shown in pairwise(story):
        new = arrange_graph(shown, places)
        assert_sound(shown, new)
        for label in places.items.keys() & new.items.keys():
            assert new.items[label] == places.items[label]
        own = {node: set(before.items_sent_by(node)) for node in before.nodes}
        for node in places.senders.rows.keys() & new.senders.rows.keys():
            if own[node] and own[node] <= set(shown.items_sent_by(node)):
                assert new.senders.rows[node] == places.senders.rows[node]
        places = new


@pytest.mark.parametrize("shown", [MAZE, DOZEN], ids=["maze", "dozen"])
def test_the_same_again_changes_nothing(shown: GraphData) -> None:
    places = arrange_graph(shown)
    assert_sound(shown, places)
    assert arrange_graph(shown) == places
    assert arrange_graph(shown, places) == places


def test_a_dozen_nodes_fit_beside_heading_details_and_keys() -> None:
    assert len(DOZEN.nodes) == 12
    assert arrange_graph(DOZEN).height <= 17


def test_another_controller_takes_the_place_of_the_one_before() -> None:
    places = arrange_graph(MAZE)
    swapped = talk(
        *(
            GraphItem(
                each.label,
                each.name,
                tuple(node.replace("random_walk", "mine") for node in each.senders),
                tuple(node.replace("random_walk", "mine") for node in each.receivers),
            )
            for each in MAZE.items
        )
    )
    new = arrange_graph(swapped, places)
    assert new.items == places.items
    assert new.senders.rows["/mine"] == places.senders.rows["/random_walk"]
    assert new.receivers.rows["/mine"] == places.receivers.rows["/random_walk"]


def test_many_that_say_the_same_sit_around_it() -> None:
    places = arrange_graph(
        talk(item("/cmd_vel", "/a /b /c /d", "/robot"), item("/scan", "/robot", "/a /b /c /d"))
    )
    rows = [places.senders.rows[node] for node in ("/a", "/b", "/c", "/d")]
    assert max(rows) - min(rows) == 3
    assert places.height <= 8


def test_nobody_and_nothing_need_no_place() -> None:
    assert arrange_graph(GraphData((), ())).height == 0
    assert arrange_graph(talk(alone="/silent")).height == 1
