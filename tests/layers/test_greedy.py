"""The slides' method: its steps, what it never gets wrong, and what it does."""

from __future__ import annotations

import random
from collections.abc import Sequence
from typing import TypeVar

import pytest

from kit.layers.assignment import find_breaches
from kit.layers.examples import EXAMPLES
from kit.layers.greedy import grow_collision_layer, run_greedy
from kit.layers.planning import solve_layers
from kit.layers.requirements import ContactRequirement, LayerCase, LayerEntity, SightRequirement
from tests.cases import every_case
from tests.layers.cases import graph, random_case

T = TypeVar("T")

SLIDES = EXAMPLES["slides-lasers"]


def test_the_first_step_is_the_slides_first_step() -> None:
    step = run_greedy(SLIDES).collision_steps[0]
    assert step.edge == ContactRequirement("Map1", "M4.B1")
    assert step.choices == SLIDES.collide
    assert [(growth.added, growth.choices) for growth in step.growth] == [("M4.B2", ("M4.B2",))]
    assert step.layer.members == {"Map1", "M4.B1", "M4.B2"}
    assert step.covered_edges == SLIDES.collide[:3]


def test_a_struck_edge_is_used_again() -> None:
    """The slides say so of M4.B1 - M4.B2."""
    second = run_greedy(SLIDES).collision_steps[1]
    assert second.layer.members == {"M4.B1", "M4.B2", "M2"}
    assert ContactRequirement("M4.B1", "M4.B2") not in second.choices


def test_each_laser_meets_every_fate_the_slides_show() -> None:
    run = run_greedy(SLIDES)
    assert [(step.laser, [group.outcome for group in step.groups]) for step in run.laser_steps] == [
        ("Ls1", ["new layer", "inside another", "new layer", "inside another"]),
        ("Ls2", ["inside another", "new layer", "inside another", "new layer", "inside another"]),
        ("Ls3", ["known group", "inside another", "inside another", "inside another", "whole layer"]),
    ]
    seen = {
        laser: {layer.members for layer in run.assignment.layers if layer.name in watched}
        for laser, watched in run.assignment.watches.items()
    }
    assert seen == {
        "Ls1": {frozenset({"Map1", "M4.B1"}), frozenset({"Map2"})},
        "Ls2": {frozenset({"M2", "Map2"}), frozenset({"M1", "Map2"})},
        "Ls3": {frozenset({"Map1", "M4.B1"}), frozenset({"M3.B2", "M1"})},
    }


@every_case("seed", range(300))
def test_the_slides_case_takes_six_and_four_in_whatever_order(seed: int) -> None:
    run = run_greedy(SLIDES, choose=random.Random(seed).choice)
    assert (len(run.collision_steps), run.size) == (6, 10)
    assert find_breaches(SLIDES, run.assignment) == ()


def test_the_player_can_choose() -> None:
    def last(choices: Sequence[T], /) -> T:
        return choices[-1]

    step = run_greedy(SLIDES, choose=last).collision_steps[0]
    assert step.edge == SLIDES.collide[-1]
    assert grow_collision_layer(SLIDES, (SLIDES.collide[4],), "C9").layer.name == "C9"


@pytest.mark.parametrize(
    ("name", "by_hand", "fewest", "missed"),
    [("greedy-trap", 4, 3, 0), ("laser-trap", 4, 3, 0), ("unseen", 2, 3, 1), ("slides", 6, 6, 0)],
)
def test_where_the_method_falls_short(name: str, by_hand: int, fewest: int, missed: int) -> None:
    run, plan = run_greedy(EXAMPLES[name]), solve_layers(EXAMPLES[name])
    assert (run.size, plan.size, len(run.missed)) == (by_hand, fewest, missed)


@every_case("seed", range(100))
def test_it_never_makes_a_contact_or_a_sighting_that_nobody_asked_for(seed: int) -> None:
    rng = random.Random(seed)
    case = random_case(rng, 8, 2, rng.random())
    run = run_greedy(case, choose=rng.choice)
    wrong = {breach.requirement: breach.is_missing for breach in find_breaches(case, run.assignment)}
    assert not any(not wanted for wanted in wrong.values())
    assert set(wrong) == set(run.missed)
    assert run.size + len(run.missed) >= solve_layers(case).size


def test_what_it_misses_is_what_collides_with_nothing() -> None:
    case = graph("a-b", lasers={"eye": "a lamp", "ear": "lamp"})
    run = run_greedy(case)
    assert run.missed == (SightRequirement("eye", "lamp"), SightRequirement("ear", "lamp"))
    assert run.assignment.watches == {"eye": ("L1",), "ear": ()}


def test_the_edges_struck_before_a_step_are_those_of_the_steps_before() -> None:
    run = run_greedy(SLIDES)
    for number, step in enumerate(run.collision_steps):
        assert run.covered_before(number).isdisjoint(step.choices)
        assert run.covered_before(number) | set(step.choices) == set(SLIDES.collide)


def test_copies_that_meet_nobody_else_get_a_layer_at_the_end() -> None:
    case = LayerCase(
        (LayerEntity("a"), LayerEntity("b"), LayerEntity("lot", copies=2)),
        (ContactRequirement("lot", "lot"), ContactRequirement("a", "b")),
    )
    run = run_greedy(case)
    assert [step.edge for step in run.collision_steps] == [
        ContactRequirement("a", "b"),
        ContactRequirement("lot", "lot"),
    ]
    assert find_breaches(case, run.assignment) == ()


def test_pairs_that_are_left_open_are_no_edges() -> None:
    run = run_greedy(graph("a-b c-d", either="a-c a-d b-c b-d"))
    assert run.size == 2
