"""What to give up when the layers do not suffice."""

from __future__ import annotations

import random
import time
from itertools import combinations

import pytest

from kit.layers.assignment import find_breaches
from kit.layers.examples import EXAMPLES
from kit.layers.planning import solve_layers
from kit.layers.relaxation import allow_unwanted, drop_requirements
from kit.layers.requirements import ContactRequirement, SightRequirement
from tests.cases import every_case
from tests.layers.cases import fewest_layers, graph, random_case, random_graph


def test_twenty_edges_without_a_triangle_give_up_four() -> None:
    found = drop_requirements(EXAMPLES["too-many"])
    assert found is not None
    assert (len(found.requirements), found.lower_bound, found.is_fewest, found.plan.size) == (4, 4, True, 16)


def test_or_allow_a_single_contact() -> None:
    found = allow_unwanted(solve_layers(EXAMPLES["too-many"]))
    assert found is not None
    assert len(found.requirements) == 1
    assert found.plan.size <= 16
    assert all(
        EXAMPLES["too-many"].relation(c.a, c.b) == "apart"
        for c in found.requirements
        if isinstance(c, ContactRequirement)
    )


@every_case("limit", [1, 2])
@every_case("seed", range(12))
def test_nothing_smaller_can_be_given_up(seed: int, limit: int) -> None:
    """Every smaller choice of requirements to give up leaves too many layers."""
    case = random_case(random.Random(seed), 4, 1, 0.6, odd=False)
    found = drop_requirements(case, limit=limit)
    assert found is not None
    assert found.is_fewest
    assert fewest_layers(case.without_requirements(found.requirements)) <= limit
    for fewer in combinations(case.requirements, len(found.requirements) - 1) if found.requirements else ():
        assert fewest_layers(case.without_requirements(fewer)) > limit


@every_case("seed", range(12))
def test_what_is_tolerated_is_enough(seed: int) -> None:
    plan = solve_layers(random_case(random.Random(seed), 6, 2, 0.5, odd=False))
    found = allow_unwanted(plan, limit=2)
    assert found is not None
    assert found.plan.size <= 2
    for what in found.requirements:
        if isinstance(what, ContactRequirement):
            assert plan.case.relation(what.a, what.b) == "apart"
        else:
            assert plan.case.laser[what.laser].sighting(what.entity) == "blind"


def test_nothing_is_sacrificed_where_everything_fits() -> None:
    case = EXAMPLES["slides-lasers"]
    given, allowed = drop_requirements(case), allow_unwanted(solve_layers(case))
    assert given is not None
    assert allowed is not None
    assert given.requirements == allowed.requirements == ()


def test_a_layer_of_two_maps_is_never_proposed() -> None:
    case = graph("m1-a m2-a", maps="m1 m2", lasers={})
    assert allow_unwanted(solve_layers(case), limit=1) is None
    given = drop_requirements(case, limit=1)
    assert given is not None
    assert len(given.requirements) == 1


def test_a_sighting_can_be_what_is_given_up() -> None:
    case = graph("a-b", lasers={"eye": "a"})
    given = drop_requirements(case, limit=1)
    assert given is not None
    assert given.requirements in ((ContactRequirement("a", "b"),), (SightRequirement("eye", "a"),))


@pytest.mark.long
@pytest.mark.parametrize(("count", "density"), [(47, 0.467), (150, 0.2), (1000, 0.01)])
def test_a_limit_of_time_is_kept_for_the_ways_out_too(count: int, density: float) -> None:
    """In seconds of the processor, and with much room: they once took minutes."""
    case, limit = random_graph(random.Random(2), count, density), 1.0
    start = time.process_time()
    plan = solve_layers(case, time_limit=limit)
    given, allowed = drop_requirements(case, time_limit=limit), allow_unwanted(plan, time_limit=limit)
    assert time.process_time() - start < 10 * limit
    assert find_breaches(case, plan.assignment) == ()
    for way_out in (given, allowed):
        assert way_out is None or way_out.plan.size <= 16
