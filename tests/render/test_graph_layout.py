"""Where things stand: no two in one place, lines kept apart, and nothing that jumps."""

from __future__ import annotations

from itertools import combinations, pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from kit.render.graph import LEVEL, UPRIGHT, Link, Plan
from kit.render.graph_data import Conversation, Item
from kit.render.graph_layout import Places, arrange
from tests.render.conversations import DOZEN, MAZE, item, talk

NODES = [f"/node{number}" for number in range(8)]
some_nodes = st.lists(st.sampled_from(NODES), max_size=5, unique=True).map(tuple)
some_items = st.dictionaries(
    st.sampled_from([f"/topic{number}" for number in range(9)]), st.tuples(some_nodes, some_nodes), max_size=9
)
conversations = st.tuples(some_items, some_nodes).map(
    lambda drawn: talk(
        *(Item(name, name, senders, receivers) for name, (senders, receivers) in sorted(drawn[0].items())),
        alone=" ".join(drawn[1]),
    )
)


def assert_sound(shown: Conversation, places: Places) -> None:
    """Everything has a place of its own, and lines that do not belong together touch nowhere."""
    assert set(places.items) == {each.label for each in shown.items}
    seated = places.senders.seats.keys() | places.receivers.seats.keys()
    assert seated == set(shown.nodes)
    for rows in (places.items, places.senders.seats, places.receivers.seats):
        assert len(set(rows.values())) == len(rows)
    plan = Plan(shown, places, 80)
    met: dict[object, list[tuple[Link, int]]] = {}
    for link, way in plan.ways.items():
        for cell, leads in way.cells:
            met.setdefault(cell, []).append((link, leads))
    for links in met.values():
        for (one, leads), (other, others) in combinations(links, 2):
            crossing = {leads, others} == {LEVEL, UPRIGHT}
            assert crossing or one.node == other.node or one.item == other.item, (one, other)


@given(conversations)
def test_all_that_talk_have_places_and_their_lines_are_apart(shown: Conversation) -> None:
    assert_sound(shown, arrange(shown))


@given(st.lists(conversations, min_size=2, max_size=4))
def test_nothing_jumps_when_something_joins_or_leaves(story: list[Conversation]) -> None:
    places = arrange(story[0])
    for before, shown in pairwise(story):
        new = arrange(shown, places)
        assert_sound(shown, new)
        for label in places.items.keys() & new.items.keys():
            assert new.items[label] == places.items[label]
        own = {node: set(before.sent_by(node)) for node in before.nodes}
        for node in places.senders.seats.keys() & new.senders.seats.keys():
            if own[node] and own[node] <= set(shown.sent_by(node)):
                assert new.senders.seats[node] == places.senders.seats[node]
        places = new


@pytest.mark.parametrize("shown", [MAZE, DOZEN], ids=["maze", "dozen"])
def test_the_same_again_changes_nothing(shown: Conversation) -> None:
    places = arrange(shown)
    assert_sound(shown, places)
    assert arrange(shown) == places
    assert arrange(shown, places) == places


def test_a_dozen_nodes_fit_beside_heading_details_and_keys() -> None:
    assert len(DOZEN.nodes) == 12
    assert arrange(DOZEN).height <= 17


def test_another_controller_takes_the_place_of_the_one_before() -> None:
    places = arrange(MAZE)
    swapped = talk(
        *(
            Item(
                each.label,
                each.name,
                tuple(node.replace("random_walk", "mine") for node in each.senders),
                tuple(node.replace("random_walk", "mine") for node in each.receivers),
            )
            for each in MAZE.items
        )
    )
    new = arrange(swapped, places)
    assert new.items == places.items
    assert new.senders.seats["/mine"] == places.senders.seats["/random_walk"]
    assert new.receivers.seats["/mine"] == places.receivers.seats["/random_walk"]


def test_many_that_say_the_same_sit_around_it() -> None:
    places = arrange(talk(item("/cmd_vel", "/a /b /c /d", "/robot"), item("/scan", "/robot", "/a /b /c /d")))
    rows = [places.senders.seats[node] for node in ("/a", "/b", "/c", "/d")]
    assert max(rows) - min(rows) == 3
    assert places.height <= 8


def test_nobody_and_nothing_need_no_place() -> None:
    assert arrange(Conversation((), ())).height == 0
    assert arrange(talk(alone="/silent")).height == 1
