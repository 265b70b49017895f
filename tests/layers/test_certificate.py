"""Certificates: they hold when checked from the definitions, and a false one does not."""

from __future__ import annotations

import random
from fractions import Fraction

import pytest

from kit.layers.candidates import find_candidates
from kit.layers.examples import EXAMPLES
from kit.layers.planning import BoundCertificate, greedy_conflict_clique, is_valid_certificate, solve_layers
from kit.layers.requirements import ContactRequirement, Requirement, SightRequirement
from tests.cases import every_case
from tests.layers.cases import random_case

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
    assert is_valid_certificate(SLIDES, find_candidates(SLIDES), certificate)
    assert certificate.bound == 10


@pytest.mark.parametrize(
    "another",
    [ContactRequirement("Map1", "M4.B1"), SightRequirement("Ls1", "Map1"), SightRequirement("Ls3", "M1")],
)
def test_an_eleventh_does_not_fit_the_proof(another: ContactRequirement | SightRequirement) -> None:
    assert not is_valid_certificate(SLIDES, find_candidates(SLIDES), BoundCertificate((*TEN, another)))


def test_weights_that_a_layer_can_collect_prove_nothing() -> None:
    candidates = find_candidates(SLIDES)
    halves = {requirement: Fraction(1, 2) for requirement in SLIDES.requirements}
    assert not is_valid_certificate(SLIDES, candidates, BoundCertificate((), (halves,)))
    assert is_valid_certificate(SLIDES, candidates, BoundCertificate((), ({TEN[0]: Fraction(1, 2)},)))


def test_nothing_is_counted_twice_and_nothing_below_zero() -> None:
    candidates = find_candidates(SLIDES)
    half = Fraction(1, 2)
    assert not is_valid_certificate(SLIDES, candidates, BoundCertificate((TEN[1], TEN[1])))
    assert not is_valid_certificate(
        SLIDES, candidates, BoundCertificate((TEN[1],), ({ContactRequirement("M3.B2", "M1"): half},))
    )
    assert not is_valid_certificate(
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
    assert is_valid_certificate(case, find_candidates(case), plan.certificate)
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
        assert is_valid_certificate(case, find_candidates(case), plan.certificate)
    assert kinds == {"packing", "weights", "search"}


@every_case("seed", range(20))
def test_the_quick_certificate_holds_too(seed: int) -> None:
    case = random_case(random.Random(seed), 8, 2, 0.4)
    certificate = greedy_conflict_clique(case)
    assert is_valid_certificate(case, find_candidates(case), certificate)
    assert certificate.bound <= solve_layers(case).size
