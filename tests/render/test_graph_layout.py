"""Where things stand: no two in one place, lines kept apart, and nothing that jumps."""

from __future__ import annotations

from itertools import combinations, pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from kit.render.graph import HORIZONTAL, VERTICAL, GraphDrawing, GraphLink
from kit.render.graph_data import GraphData, GraphItem
from kit.render.graph_layout import GraphLayout, arrange_graph
from tests.render.conversations import DOZEN, MAZE, item, talk

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
