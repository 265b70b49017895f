"""The optimum: against exhaustive search, against families whose optimum is known, and the slides' own case."""

from __future__ import annotations

import random
import time
from collections.abc import Callable
from fractions import Fraction
from itertools import combinations

import pytest

from kit.layers.assignment import find_breaches
from kit.layers.bound_certificates import (
    BoundCertificate,
    greedy_conflict_clique,
    is_valid_optimality_certificate,
)
from kit.layers.candidates import find_candidates
from kit.layers.examples import EXAMPLES
from kit.layers.planning import solve_layers
from kit.layers.relaxations import allow_unwanted, drop_requirements
from kit.layers.requirements import (
    ContactRequirement,
    LayerCase,
    Requirement,
    SightRequirement,
    layer_conflict,
)
from tests.cases import every_case
from tests.layers.cases import (
    bipartite,
    cocktail_party,
    complete,
    fewest_layers,
    graph,
    planted,
    random_case,
    random_graph,
    random_tree,
)


@pytest.mark.parametrize("seed", range(10))
def test_the_same_optimum_as_exhaustive_search_on_a_thousand_cases(seed: int) -> None:
    rng = random.Random(seed)
    for _ in range(100):
        case = random_case(rng, rng.randint(0, 7), rng.randint(0, 3), rng.random())
        plan = solve_layers(case)
        assert plan.is_optimal
        assert plan.size == fewest_layers(case), case
        assert find_breaches(case, plan.assignment) == ()


def test_the_random_cases_are_not_all_easy() -> None:
    """The cases above need anything from none to many layers, and use every kind of requirement."""
    rng = random.Random(0)
    cases = [random_case(rng, rng.randint(0, 7), rng.randint(0, 3), rng.random()) for _ in range(100)]
    assert {fewest_layers(case) for case in cases} >= set(range(8))
    assert any(case.either for case in cases)
    assert any(laser.either for case in cases for laser in case.lasers)
    assert any(e.is_ghost for case in cases for e in case.entities)
    assert any(c.a == c.b for case in cases for c in case.collide)


@pytest.mark.parametrize(
    ("case", "optimum"),
    [
        (graph(""), 0),
        (complete(2), 1),
        (complete(9), 1),
        (bipartite(1, 7), 7),
        (bipartite(4, 4), 16),
        (bipartite(4, 5), 20),
        (cocktail_party(2), 4),
        (cocktail_party(3), 4),
        (cocktail_party(4), 5),
        (cocktail_party(5), 6),
        (cocktail_party(6), 6),
        (graph("a-b b-c c-d d-e e-a"), 5),
        (graph("a-b b-c c-a c-d d-e e-c"), 2),
    ],
)
def test_families_whose_optimum_is_known(case: LayerCase, optimum: int) -> None:
    """K_n takes one clique, a triangle-free graph one per edge, a cocktail party of n couples the least k with
    n <= binomial(k - 1, ceil(k / 2)) (Gregory and Pullman 1982)."""
    plan = solve_layers(case)
    assert (plan.size, plan.bound) == (optimum, optimum)


@every_case("seed", range(5))
def test_a_tree_takes_as_many_layers_as_it_has_edges(seed: int) -> None:
    case = random_tree(random.Random(seed), 30)
    assert solve_layers(case).size == 29


def test_eight_entities_always_fit_sixteen_layers() -> None:
    rng = random.Random(3)
    assert all(solve_layers(random_graph(rng, 8, rng.random())).size <= 16 for _ in range(200))


@pytest.mark.parametrize(
    ("name", "one_model_never_collides", "optimum"),
    [("slides", False, 6), ("slides-lasers", False, 10), ("slides-lasers", True, 9)],
)
def test_the_slides(name: str, one_model_never_collides: bool, optimum: int) -> None:
    case = EXAMPLES[name].without_self_collisions() if one_model_never_collides else EXAMPLES[name]
    plan = solve_layers(case)
    assert (plan.size, plan.bound, plan.certificate.bound) == (optimum, optimum, optimum)
    assert len(plan.certificate.conflicting) == optimum
    assert all(layer_conflict(case, one, two) for one, two in combinations(plan.certificate.conflicting, 2))


def test_the_slides_six_maximal_cliques_are_all_needed() -> None:
    found = {layer.members for layer in solve_layers(EXAMPLES["slides"]).assignment.layers}
    assert found == {
        frozenset(names.split())
        for names in (
            "Map1 M4.B1 M4.B2",
            "M4.B1 M4.B2 M2",
            "M2 M3.B2",
            "M3.B2 M1",
            "Map2 M1 M3.B1",
            "Map2 M2 M3.B1",
        )
    }


def test_a_ghost_beacon_saves_the_tutorials_fourth_layer() -> None:
    plan = solve_layers(EXAMPLES["beacon"])
    assert {layer.members for layer in plan.assignment.layers} == {
        frozenset({"walls", "robot"}),
        frozenset({"walls"}),
        frozenset({"robot"}),
    }
    assert plan.assignment.layers_of("beacon") == ()


@pytest.mark.parametrize(
    "make", [lambda rng: random_case(rng, 12, 3, 0.5), lambda rng: planted(rng, 30, 4, 9, 12)]
)
def test_the_same_plan_every_time(make: Callable[[random.Random], LayerCase]) -> None:
    case = make(random.Random(11))
    assert solve_layers(case).assignment == solve_layers(case).assignment


def test_a_planted_plan_is_never_beaten_by_a_worse_one() -> None:
    rng = random.Random(5)
    for _ in range(10):
        plan = solve_layers(planted(rng, 25, 3, 8, 10))
        assert plan.is_optimal
        # eight groups, and for a laser at worst those it watches once more, without what it must not see
        assert plan.size <= 8 + 3 * 3


@pytest.mark.long
@pytest.mark.parametrize(
    "case",
    [random_graph(random.Random(1), 45, 0.5), random_case(random.Random(1), 60, 20, 0.3)],
    ids=["too many cliques", "too many lasers"],
)
def test_a_plan_cut_short_is_honest(case: LayerCase) -> None:
    """Too little time: a plan that does what is asked, with a bound that is one, and no claim that it is the best."""
    start = time.monotonic()
    plan = solve_layers(case, time_limit=0.3)
    assert time.monotonic() - start < 10  # on a machine that does much else besides
    assert find_breaches(case, plan.assignment) == ()
    assert 0 < plan.bound <= plan.size
    assert plan.certificate.bound <= plan.bound
    assert plan.gap == plan.size - plan.bound


def test_no_time_at_all_still_gives_a_plan_and_a_bound() -> None:
    case = EXAMPLES["slides-lasers"]
    plan = solve_layers(case, time_limit=1e-9)
    assert find_breaches(case, plan.assignment) == ()
    assert plan.bound <= 10 <= plan.size


def test_a_laser_and_a_contact_need_not_cost_two_layers() -> None:
    case = graph("a-b", lasers={"eye": "a b"})
    plan = solve_layers(case)
    assert plan.size == 1
    assert plan.assignment.watches["eye"] == ("C1",)
    assert plan.case.requirements == (
        ContactRequirement("a", "b"),
        SightRequirement("eye", "a"),
        SightRequirement("eye", "b"),
    )


SLIDES = EXAMPLES["slides-lasers"]

TEN = (
    ContactRequirement("M2", "M3.B2"),
    ContactRequirement("M1", "M3.B2"),
    ContactRequirement("Map1", "M4.B2"),
    ContactRequirement("M4.B1", "M2"),
    ContactRequirement("M2", "M3.B1"),
    ContactRequirement("M1", "M3.B1"),
    SightRequirement("Ls1", "Map2"),
    SightRequirement("Ls2", "M1"),
    SightRequirement("Ls2", "M2"),
    SightRequirement("Ls3", "Map1"),
)
"""Ten requirements of the slides' case, found by hand, of which no two fit one layer."""


def test_ten_requirements_prove_the_slides_ten_layers() -> None:
    certificate = BoundCertificate(TEN)
    assert is_valid_optimality_certificate(SLIDES, find_candidates(SLIDES), certificate)
    assert certificate.bound == 10


@pytest.mark.parametrize(
    "another",
    [ContactRequirement("Map1", "M4.B1"), SightRequirement("Ls1", "Map1"), SightRequirement("Ls3", "M1")],
)
def test_an_eleventh_does_not_fit_the_proof(another: ContactRequirement | SightRequirement) -> None:
    assert not is_valid_optimality_certificate(
        SLIDES, find_candidates(SLIDES), BoundCertificate((*TEN, another))
    )


def test_weights_that_a_layer_can_collect_prove_nothing() -> None:
    candidates = find_candidates(SLIDES)
    halves = {requirement: Fraction(1, 2) for requirement in SLIDES.requirements}
    assert not is_valid_optimality_certificate(SLIDES, candidates, BoundCertificate((), (halves,)))
    assert is_valid_optimality_certificate(
        SLIDES, candidates, BoundCertificate((), ({TEN[0]: Fraction(1, 2)},))
    )


def test_nothing_is_counted_twice_and_nothing_below_zero() -> None:
    candidates = find_candidates(SLIDES)
    half = Fraction(1, 2)
    assert not is_valid_optimality_certificate(SLIDES, candidates, BoundCertificate((TEN[1], TEN[1])))
    assert not is_valid_optimality_certificate(
        SLIDES, candidates, BoundCertificate((TEN[1],), ({ContactRequirement("M3.B2", "M1"): half},))
    )
    assert not is_valid_optimality_certificate(
        SLIDES,
        candidates,
        BoundCertificate((), ({TEN[0]: 3 * half, ContactRequirement("M2", "M3.B1"): -half},)),
    )


def test_the_bound_rounds_every_part_up() -> None:
    half = Fraction(1, 2)
    one: dict[Requirement, Fraction] = {
        ContactRequirement("a", "b"): half,
        ContactRequirement("c", "d"): Fraction(1),
    }
    other: dict[Requirement, Fraction] = {SightRequirement("l", "a"): half}
    assert BoundCertificate((ContactRequirement("e", "f"),), (one, other)).bound == 1 + 2 + 1


@every_case("seed", range(40))
def test_every_plans_certificate_holds(seed: int) -> None:
    rng = random.Random(seed)
    case = random_case(rng, 10, 3, 0.6)
    plan = solve_layers(case)
    assert is_valid_optimality_certificate(case, find_candidates(case), plan.certificate)
    assert plan.certificate.bound <= plan.bound == plan.size


@pytest.mark.long
def test_weights_are_used_where_no_packing_is_large_enough() -> None:
    """Among a few hundred cases of ten entities there are some of each kind."""
    kinds = set()
    for seed in range(300):
        case = random_case(random.Random(seed), 10, 2, 0.6, either=0.0, odd=False)
        plan = solve_layers(case)
        kind = (
            "search"
            if plan.certificate.bound < plan.bound
            else "weights"
            if plan.certificate.weighted_parts
            else "packing"
        )
        kinds.add(kind)
        assert is_valid_optimality_certificate(case, find_candidates(case), plan.certificate)
    assert kinds == {"packing", "weights", "search"}


@every_case("seed", range(20))
def test_the_quick_certificate_holds_too(seed: int) -> None:
    case = random_case(random.Random(seed), 8, 2, 0.4)
    certificate = greedy_conflict_clique(case)
    assert is_valid_optimality_certificate(case, find_candidates(case), certificate)
    assert certificate.bound <= solve_layers(case).size


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
