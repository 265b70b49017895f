"""Assignments are judged by the definition alone, whoever made them."""

from __future__ import annotations

import random
from dataclasses import replace

from kit.layers.assignment import LayerAssignment, NamedLayer, drop_superfluous, find_breaches, name_layers
from kit.layers.candidates import find_candidates
from kit.layers.examples import EXAMPLES
from kit.layers.requirements import ContactRequirement, LayerCase, LayerEntity, SightRequirement
from tests.cases import every_case
from tests.layers.cases import graph, random_case, slides_assignment

SLIDES = EXAMPLES["slides-lasers"]


def test_the_slides_own_assignment_does_what_it_should_with_ten_layers() -> None:
    slides = slides_assignment()
    assert len(slides.layers) == 10
    assert find_breaches(SLIDES, slides) == ()
    assert slides.layers_of("Map2") == ("C5", "C6", "L2", "L3", "L4")
    assert slides.layers_of("M2") == ("C2", "C3", "C6", "L2")


@every_case("layer", range(10))
def test_none_of_the_slides_layers_can_be_left_out(layer: int) -> None:
    slides = slides_assignment()
    gone = slides.layers[layer].name
    watches = {
        laser: tuple(name for name in watched if name != gone) for laser, watched in slides.watches.items()
    }
    assert find_breaches(SLIDES, LayerAssignment(slides.layers[:layer] + slides.layers[layer + 1 :], watches))


def assigned(watches: dict[str, tuple[str, ...]] | None = None, **layers: str) -> LayerAssignment:
    return LayerAssignment(
        tuple(NamedLayer(name, frozenset(members.split())) for name, members in layers.items()), watches or {}
    )


def test_every_kind_of_breach_is_found_with_the_layers_to_blame() -> None:
    case = graph("a-b", lasers={"eye": "a c"})
    case = replace(case, entities=(*case.entities, LayerEntity("lot", copies=2)))
    found = find_breaches(case, assigned({"eye": ("x", "y")}, x="b c lot", y="b c", z="a"))
    facts = {(breach.requirement, breach.is_missing): breach.layers for breach in found}
    assert facts == {
        (ContactRequirement("a", "b"), True): (),
        (ContactRequirement("b", "c"), False): ("x", "y"),
        (ContactRequirement("b", "lot"), False): ("x",),
        (ContactRequirement("c", "lot"), False): ("x",),
        (ContactRequirement("lot", "lot"), False): ("x",),
        (SightRequirement("eye", "a"), True): (),
        (SightRequirement("eye", "b"), False): ("x", "y"),
        (SightRequirement("eye", "lot"), False): ("x",),
    }
    assert all("must" in str(breach) for breach in found)


def test_a_lone_entity_in_a_layer_meets_its_copies_there() -> None:
    case = LayerCase((LayerEntity("lot", copies=2),), (ContactRequirement("lot", "lot"),))
    assert find_breaches(case, assigned(x="lot")) == ()
    assert [breach.is_missing for breach in find_breaches(case, assigned(x=""))] == [True]


@every_case("seed", range(30))
def test_what_nothing_rests_on_is_left_out(seed: int) -> None:
    """From all candidates at once: afterwards every membership and every watched layer is needed."""
    case = random_case(random.Random(seed), 6, 2, 0.5)
    layers, watches = drop_superfluous(case, find_candidates(case).layers)
    assignment = name_layers(case, layers, watches)
    assert find_breaches(case, assignment) == ()
    for layer in assignment.layers:
        for member in layer.members:
            less = [NamedLayer(x.name, x.members - {member}) if x == layer else x for x in assignment.layers]
            assert find_breaches(case, LayerAssignment(tuple(less), assignment.watches))
    for laser, watched in assignment.watches.items():
        for name in watched:
            less_seen = {**assignment.watches, laser: tuple(w for w in watched if w != name)}
            assert find_breaches(case, LayerAssignment(assignment.layers, less_seen))


def test_layers_for_lasers_alone_are_called_l() -> None:
    case = graph("a-b", lasers={"eye": "a"})
    found = name_layers(case, [frozenset("a"), frozenset("ab")], {"eye": [0]})
    assert [(layer.name, layer.members) for layer in found.layers] == [
        ("C1", frozenset("ab")),
        ("L1", frozenset("a")),
    ]
    assert found.watches == {"eye": ("L1",)}
