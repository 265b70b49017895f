"""Assignments are judged by the definition alone, whoever made them."""

from __future__ import annotations

import random
from dataclasses import replace

import pytest

from kit.layers.assignment import Assignment, NamedLayer, breaches, lean, named
from kit.layers.candidates import find_candidates
from kit.layers.examples import EXAMPLES, deck_assignment
from kit.layers.requirements import Case, Contact, Entity, Sight
from tests.layers.cases import graph, random_case

SLIDES = EXAMPLES["slides-lasers"]


def test_the_slides_own_assignment_does_what_it_should_with_ten_layers() -> None:
    deck = deck_assignment()
    assert len(deck.layers) == 10
    assert breaches(SLIDES, deck) == ()
    assert deck.layers_of("Map2") == ("C5", "C6", "L2", "L3", "L4")
    assert deck.layers_of("M2") == ("C2", "C3", "C6", "L2")


@pytest.mark.parametrize("layer", range(10))
def test_none_of_the_slides_layers_can_be_left_out(layer: int) -> None:
    deck = deck_assignment()
    gone = deck.layers[layer].name
    watches = {
        laser: tuple(name for name in watched if name != gone) for laser, watched in deck.watches.items()
    }
    assert breaches(SLIDES, Assignment(deck.layers[:layer] + deck.layers[layer + 1 :], watches))


def assigned(watches: dict[str, tuple[str, ...]] | None = None, **layers: str) -> Assignment:
    return Assignment(
        tuple(NamedLayer(name, frozenset(members.split())) for name, members in layers.items()), watches or {}
    )


def test_every_kind_of_breach_is_found_with_the_layers_to_blame() -> None:
    case = graph("a-b", lasers={"eye": "a c"})
    case = replace(case, entities=(*case.entities, Entity("lot", copies=2)))
    found = breaches(case, assigned({"eye": ("x", "y")}, x="b c lot", y="b c", z="a"))
    facts = {(breach.what, breach.wanted): breach.layers for breach in found}
    assert facts == {
        (Contact("a", "b"), True): (),
        (Contact("b", "c"), False): ("x", "y"),
        (Contact("b", "lot"), False): ("x",),
        (Contact("c", "lot"), False): ("x",),
        (Contact("lot", "lot"), False): ("x",),
        (Sight("eye", "a"), True): (),
        (Sight("eye", "b"), False): ("x", "y"),
        (Sight("eye", "lot"), False): ("x",),
    }
    assert all("must" in str(breach) for breach in found)


def test_a_lone_entity_in_a_layer_meets_its_copies_there() -> None:
    case = Case((Entity("lot", copies=2),), (Contact("lot", "lot"),))
    assert breaches(case, assigned(x="lot")) == ()
    assert [breach.wanted for breach in breaches(case, assigned(x=""))] == [True]


@pytest.mark.parametrize("seed", range(30))
def test_what_nothing_rests_on_is_left_out(seed: int) -> None:
    """From all candidates at once: afterwards every membership and every watched layer is needed."""
    case = random_case(random.Random(seed), 6, 2, 0.5)
    layers, watches = lean(case, find_candidates(case).layers)
    assignment = named(case, layers, watches)
    assert breaches(case, assignment) == ()
    for layer in assignment.layers:
        for member in layer.members:
            less = [NamedLayer(x.name, x.members - {member}) if x == layer else x for x in assignment.layers]
            assert breaches(case, Assignment(tuple(less), assignment.watches))
    for laser, watched in assignment.watches.items():
        for name in watched:
            less_seen = {**assignment.watches, laser: tuple(w for w in watched if w != name)}
            assert breaches(case, Assignment(assignment.layers, less_seen))


def test_layers_for_lasers_alone_are_called_l() -> None:
    case = graph("a-b", lasers={"eye": "a"})
    found = named(case, [frozenset("a"), frozenset("ab")], {"eye": [0]})
    assert [(layer.name, layer.members) for layer in found.layers] == [
        ("C1", frozenset("ab")),
        ("L1", frozenset("a")),
    ]
    assert found.watches == {"eye": ("L1",)}
