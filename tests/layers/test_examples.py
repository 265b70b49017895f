"""The examples are what their titles say."""

from __future__ import annotations

from kit.layers.examples import EXAMPLES
from kit.layers.planning import solve_layers
from tests.cases import every_case

LAYERS = {
    "two": 1,
    "blind-spot": 2,
    "three": 1,
    "drone": 2,
    "beacon": 3,
    "slides": 6,
    "slides-lasers": 10,
    "greedy-trap": 3,
    "laser-trap": 3,
    "unseen": 3,
    "too-many": 20,
}


@every_case("name", EXAMPLES)
def test_every_example_takes_the_layers_it_is_there_for(name: str) -> None:
    plan = solve_layers(EXAMPLES[name])
    assert plan.size == LAYERS[name]
    assert plan.certificate.bound == plan.size  # each can be proved by hand
    assert EXAMPLES[name].title


def test_the_first_have_two_and_three_entities() -> None:
    assert [len(case.names) for case in EXAMPLES.values()][:4] == [2, 2, 3, 3]


def test_the_slides_example_has_its_twelve_edges() -> None:
    assert len(EXAMPLES["slides"].edges()) == 12
    assert EXAMPLES["slides"].collide == EXAMPLES["slides-lasers"].collide
