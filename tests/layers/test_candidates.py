"""The layers worth considering."""

from __future__ import annotations

import random
import time
from itertools import combinations

import pytest

from kit.layers import candidates
from kit.layers.candidates import RequirementRows, find_candidates, sharing_graph, visible_sets
from kit.layers.examples import EXAMPLES
from kit.layers.requirements import ContactRequirement, LaserEntity, LayerCase, LayerEntity
from tests.cases import every_case
from tests.layers.cases import cocktail_party, graph, random_case, random_graph


def test_the_slides_have_exactly_six_maximal_cliques() -> None:
    assert len(find_candidates(EXAMPLES["slides"]).layers) == 6


def test_the_slides_case_has_eight_entities_and_twelve_edges() -> None:
    case = EXAMPLES["slides"]
    assert (len(case.names), len(set(case.edges()))) == (8, 12)


@every_case("seed", range(20))
def test_a_candidate_is_a_layer_that_nothing_can_join(seed: int) -> None:
    """Maximal among the cliques of what some set of lasers may see."""
    case = random_case(random.Random(seed), 7, 3, 0.4, odd=False)
    found = find_candidates(case)
    assert found.is_complete
    for layer in found.layers:
        assert all(case.relation(a, b) != "apart" for a, b in combinations(layer, 2))
        watchers = [laser for laser in case.lasers if laser.sees and layer.isdisjoint(case.blind_set(laser))]
        joining = {
            name
            for name in set(case.names) - layer
            if all(case.relation(name, member) != "apart" for member in layer)
            and all(laser.sighting(name) != "blind" for laser in watchers)
        }
        # whoever could join the layer with all its lasers is told apart by a laser that no requirement needs here
        served = RequirementRows(case).served_by(layer)
        assert all(RequirementRows(case).served_by(layer | {name}) <= served for name in joining)


@every_case("seed", range(20))
def test_every_requirement_has_a_candidate(seed: int) -> None:
    case = random_case(random.Random(seed), 8, 3, 0.5)
    found = find_candidates(case)
    assert frozenset().union(*found.covers) == frozenset(range(len(case.requirements)))


def test_a_layer_serves_a_sighting_only_if_the_laser_may_see_all_of_it() -> None:
    case = graph("a-b b-c", lasers={"eye": "a b"})
    rows = RequirementRows(case)
    assert rows.served_by(frozenset("ab")) == {0, 2, 3}
    assert rows.served_by(frozenset("bc")) == {1}


def test_a_layer_may_use_pairs_that_are_left_open() -> None:
    assert find_candidates(graph("a-b c-d", either="a-c a-d b-c b-d")).layers == (frozenset("abcd"),)


def test_who_must_not_meet_its_own_copies_is_in_no_layer() -> None:
    case = LayerCase(
        (LayerEntity("a"), LayerEntity("b"), LayerEntity("lot", copies=2)),
        (ContactRequirement("a", "b"),),
        frozenset({ContactRequirement("a", "lot")}),
    )
    assert "lot" not in sharing_graph(case)
    assert find_candidates(case).layers == (frozenset("ab"),)


def test_lasers_with_the_same_blind_spots_are_searched_once() -> None:
    case = graph("a-b b-c", lasers={f"l{i}": "a b" for i in range(30)})
    assert visible_sets(case) == [frozenset("abc"), frozenset("ab")]


@pytest.mark.parametrize("limits", [{"limit": 1}, {"deadline": 0.0}])
def test_a_search_cut_short_says_so_and_still_serves_everything(limits: dict[str, float]) -> None:
    case = cocktail_party(10)  # 1,024 candidates
    found = find_candidates(case, **limits)  # type: ignore[arg-type]  # one of the two, by its name
    assert not found.is_complete
    assert len(found.layers) < 1024
    assert frozenset().union(*found.covers) == frozenset(range(len(case.requirements)))


@pytest.mark.long
def test_very_many_different_lasers_do_not_take_for_ever() -> None:
    names = [f"e{i}" for i in range(16)]
    lasers = tuple(LaserEntity(f"l{i}", frozenset(names) - {name}) for i, name in enumerate(names))
    case = LayerCase(tuple(map(LayerEntity, names)), (), lasers=lasers)
    start = time.monotonic()
    found = find_candidates(case)
    assert not found.is_complete
    assert time.monotonic() - start < 20


def test_layers_grown_where_the_search_was_cut_short_are_maximal() -> None:
    case = random_graph(random.Random(4), 12, 0.5)
    cut, whole = find_candidates(case, deadline=0.0), find_candidates(case)
    assert set(cut.layers) <= set(whole.layers)


def test_so_many_sets_that_lasers_see_are_searched(monkeypatch: pytest.MonkeyPatch) -> None:
    pairs = " ".join(f"{name}-z" for name in "abcd")

    def found(lasers: int) -> candidates.CandidateLayers:
        """Each further laser is blind to another body, and doubles the sets."""
        eyes = {f"eye{blind}": "z " + " ".join(set("abcd") - {blind}) for blind in "abcd"[:lasers]}
        return find_candidates(graph(pairs, lasers=eyes))

    monkeypatch.setattr(candidates, "MAX_VISIBLE_SETS", 8)
    assert found(3).is_complete
    assert not found(4).is_complete


def test_a_set_that_nobody_sees_does_not_count_among_those_that_are_searched(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Else one that was left out would take its place, and a search cut short would pass for complete."""
    lasers = {"eye1": "b c e", "eye2": "a c e", "eye3": "a d", "eye4": "e"}
    case = graph("a-b b-c c-d d-e", lasers=lasers)
    count = len(visible_sets(case))
    monkeypatch.setattr(candidates, "MAX_VISIBLE_SETS", count)
    assert find_candidates(case).is_complete
    for most in range(1, count):
        monkeypatch.setattr(candidates, "MAX_VISIBLE_SETS", most)
        assert not find_candidates(case).is_complete
