"""The ways out where Flatland has too few layers: requirements to drop, unwanted contacts to allow."""

from __future__ import annotations

import time
from collections.abc import Iterable
from dataclasses import dataclass

from kit.layers.candidates import find_candidates
from kit.layers.cover import minimum_uncovered
from kit.layers.planning import DEFAULT_TIME_LIMIT, LayerPlan, solve_layers
from kit.layers.requirements import (
    ContactRequirement,
    LayerCase,
    Requirement,
    SightRequirement,
)
from kit.world.records import MAX_LAYERS


@dataclass(frozen=True, slots=True)
class Relaxation:
    """Requirements to drop or unwanted contacts to allow, and the plan of the relaxed case."""

    requirements: tuple[Requirement, ...]
    lower_bound: int
    """Proved: no smaller sacrifice of this kind will do. 0 where nothing is proved."""
    plan: LayerPlan

    @property
    def is_fewest(self) -> bool:
        return self.lower_bound == len(self.requirements)


def drop_requirements(
    case: LayerCase, *, limit: int = MAX_LAYERS, time_limit: float = DEFAULT_TIME_LIMIT
) -> Relaxation | None:
    """The fewest requirements without which ``limit`` layers do. None: none found in time."""
    if not case.requirements:
        return Relaxation((), 0, solve_layers(case))
    deadline = time.monotonic() + time_limit
    candidates = find_candidates(case, deadline=time.monotonic() + time_limit / 4)
    rows = len(case.requirements)
    selection = minimum_uncovered(candidates.covers, rows, limit, (deadline - time.monotonic()) / 2)
    if selection is None:
        return None
    served = frozenset().union(*(candidates.covers[i] for i in selection.chosen))
    dropped = tuple(requirement for row, requirement in enumerate(case.requirements) if row not in served)
    plan = solve_layers(case.without_requirements(dropped), time_limit=max(0.1, deadline - time.monotonic()))
    return (
        Relaxation(dropped, selection.bound if candidates.is_complete else 0, plan)
        if plan.size <= limit
        else None
    )


def allow_unwanted(
    plan: LayerPlan, *, limit: int = MAX_LAYERS, time_limit: float = DEFAULT_TIME_LIMIT
) -> Relaxation | None:
    """Few unwanted contacts and sightings with which ``limit`` layers do. None: no merging leads there, or none in time."""
    case, deadline = plan.case, time.monotonic() + time_limit
    layers = [
        (
            layer.members,
            frozenset(name for name, watched in plan.assignment.watches.items() if layer.name in watched),
        )
        for layer in plan.assignment.layers
    ]
    tolerated: set[Requirement] = set()
    left = dict(enumerate(layers))
    prices: dict[tuple[int, int], frozenset[Requirement]] = {}
    new = list(left)
    while len(left) > limit:
        # Invariant: ``prices`` holds every pair of ``left`` that can be merged, but for pairs with one of ``new``.
        for j in new:
            if time.monotonic() > deadline:
                return None
            for i in left:
                if i < j and (price := _merge_cost(case, left[i], left[j])) is not None:
                    prices[i, j] = price
        if not prices or time.monotonic() > deadline:
            return None
        i, j = min(prices, key=lambda pair: (len(prices[pair] - tolerated), pair))
        tolerated |= prices[i, j]
        one, other = left.pop(i), left.pop(j)
        prices = {pair: price for pair, price in prices.items() if i not in pair and j not in pair}
        merged = max(i, j, *left, *new) + 1
        left[merged] = one[0] | other[0], one[1] | other[1]
        new = [merged]
    what = tuple(sorted(tolerated, key=_sort_key))
    relaxed = solve_layers(case.without_requirements(what), time_limit=max(0.1, deadline - time.monotonic()))
    return Relaxation(what, 0, relaxed) if relaxed.size <= limit else None


_WatchedLayer = tuple[frozenset[str], frozenset[str]]
"""Members, and the lasers that watch."""


def _merge_cost(case: LayerCase, one: _WatchedLayer, other: _WatchedLayer) -> frozenset[Requirement] | None:
    """Returns the unwanted contacts and sightings of merging two layers; None if they cannot be merged (two maps)."""
    unwanted: set[Requirement] = set()
    only_other = other[0] - one[0]
    for a in one[0] - other[0]:
        for b in only_other - case.may_share[a]:
            if case.by_name[a].kind == case.by_name[b].kind == "map":
                return None
            unwanted.add(ContactRequirement(a, b))
    for laser, (members, _) in _lasers_across(one, other):
        unwanted.update(
            SightRequirement(laser, name) for name in members if case.laser[laser].sighting(name) == "blind"
        )
    return frozenset(unwanted)


def _lasers_across(one: _WatchedLayer, other: _WatchedLayer) -> Iterable[tuple[str, _WatchedLayer]]:
    """Each laser of one layer with the other layer, whose members it would come to see."""
    yield from ((laser, other) for laser in one[1])
    yield from ((laser, one) for laser in other[1])


def _sort_key(requirement: Requirement) -> tuple[bool, str]:
    return isinstance(requirement, SightRequirement), str(requirement)
