"""From a case to its plan: the fewest layers, the assignment and the proof; and the ways out where Flatland has too few.

The proof is a lower bound on the number of layers that a person can check. A certificate counts requirements of which no
two fit one layer: ten such requirements need ten layers. Where no such set is large enough, requirements are given weights
so that no layer whatever collects more than 1: a total weight of 7 1/2 needs eight layers. Both are checked here from the
definitions, without the solver that found them; only where neither reaches the optimum is the solver's exhaustive search
all there is to go by.

There are two ways out. *Give up requirements*: the fewest contacts and sightings that are no longer required, exactly, by
the same set cover with a price for each row left uncovered. *Tolerate* contacts and sightings that should not happen, by
merging layers, at each step the two whose union brings the fewest; quick, and often much cheaper than the first way, but
not proved the fewest.
"""

from __future__ import annotations

import math
import time
from collections import defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from fractions import Fraction

from kit.layers.assignment import LayerAssignment, drop_superfluous, find_breaches, name_layers
from kit.layers.candidates import CandidateLayers, find_candidates
from kit.layers.cover import SetCover, minimum_cover, minimum_uncovered
from kit.layers.requirements import (
    ContactRequirement,
    LayerCase,
    Requirement,
    SightRequirement,
    layer_conflict,
    required_entities,
)
from kit.world.records import MAX_LAYERS

RequirementWeights = Mapping[Requirement, Fraction]


@dataclass(frozen=True, slots=True)
class BoundCertificate:
    """A lower bound on the number of layers, with its reasons.

    ``bound`` = len(conflicting) + the sum of the weights of each part, rounded up.
    """

    conflicting: tuple[Requirement, ...]
    """Requirements of which no two fit one layer."""
    weighted_parts: tuple[RequirementWeights, ...] = ()
    """Weights, of which no layer collects more than 1; no layer serves two parts, nor a part and one of ``conflicting``."""

    @property
    def bound(self) -> int:
        return len(self.conflicting) + sum(math.ceil(sum(part.values())) for part in self.weighted_parts)


def build_certificate(
    case: LayerCase, candidates: CandidateLayers, cover: SetCover, *, deadline: float = math.inf
) -> BoundCertificate:
    """The reasons a cover came with, as requirements; only those that hold when they are checked afresh.

    ``candidates`` must be complete for the weights to count; without them a packing that ``greedy_conflict_clique``
    finds takes their place.
    """
    if candidates.is_complete:
        found = BoundCertificate(
            tuple(case.requirements[row] for row in cover.packed_rows),
            tuple(
                {case.requirements[row]: weight for row, weight in part.items()} for part in cover.row_weights
            ),
        )
        if is_valid_optimality_certificate(case, candidates, found, deadline=deadline):
            return found
    return greedy_conflict_clique(case, deadline=deadline)


def is_valid_optimality_certificate(
    case: LayerCase,
    candidates: CandidateLayers,
    certificate: BoundCertificate,
    *,
    deadline: float = math.inf,
) -> bool:
    """Returns whether the certificate is what it claims to be, by the definitions alone, and was checked in time."""
    chosen = _ConflictingRequirements(case)
    for requirement in certificate.conflicting:
        if time.monotonic() > deadline or not chosen.add(requirement):
            return False
    if not certificate.weighted_parts:
        return True
    parts = [{requirement: Fraction(1)} for requirement in certificate.conflicting] + list(
        certificate.weighted_parts
    )
    number = {requirement: i for i, requirement in enumerate(case.requirements)}
    weight = {number[r]: (part, value) for part, weights in enumerate(parts) for r, value in weights.items()}
    if len(weight) < sum(map(len, parts)) or any(value < 0 for _, value in weight.values()):
        return False  # something is counted twice
    for served in candidates.covers:
        counted = [weight[row] for row in served if row in weight]
        if len({part for part, _ in counted}) > 1 or sum(value for _, value in counted) > 1:
            return False
    return True


def greedy_conflict_clique(case: LayerCase, *, deadline: float = math.inf) -> BoundCertificate:
    """Returns a greedy clique of mutually conflicting requirements; often not a maximum one."""
    chosen = _ConflictingRequirements(case)
    for requirement in case.requirements:
        if time.monotonic() > deadline:
            break
        chosen.add(requirement)
    return BoundCertificate(tuple(chosen.requirements))


class _ConflictingRequirements:
    """Requirements of which no two fit one layer.

    Two that fit name entities that may all share a layer: only those are compared, not every pair.
    """

    def __init__(self, case: LayerCase) -> None:
        self._case = case
        self.requirements: list[Requirement] = []
        self._by_entity: dict[str, list[Requirement]] = defaultdict(list)

    def add(self, requirement: Requirement) -> bool:
        """Adds a requirement that conflicts with all that are there; returns whether it does."""
        entities = required_entities(requirement)
        near = frozenset.intersection(*(self._case.may_share[name] | {name} for name in entities))
        if any(
            layer_conflict(self._case, requirement, other) is None
            for name in near & self._by_entity.keys()
            for other in self._by_entity[name]
        ):
            return False
        self.requirements.append(requirement)
        for name in entities:
            self._by_entity[name].append(requirement)
        return True


DEFAULT_TIME_LIMIT = 10.0
"""Seconds."""


@dataclass(frozen=True, slots=True)
class LayerPlan:
    """The layers found for a case, and what is known about how few there could be."""

    case: LayerCase
    assignment: LayerAssignment
    bound: int
    """Proved: no plan has fewer layers."""
    certificate: BoundCertificate
    """The part of the proof that can be checked by hand; its own bound may be lower."""
    candidate_count: int
    """Number of candidate layers considered."""
    seconds: float

    @property
    def size(self) -> int:
        return len(self.assignment.layers)

    @property
    def is_optimal(self) -> bool:
        return self.bound == self.size

    @property
    def gap(self) -> int:
        """Returns by how many layers the unknown optimum could be smaller."""
        return self.size - self.bound


def solve_layers(case: LayerCase, *, time_limit: float = DEFAULT_TIME_LIMIT) -> LayerPlan:
    """The plan with the fewest layers, proved; or within ``time_limit`` [s] the best found, with bound and gap.

    At most 40 percent of the time goes to listing candidate layers. The plan is the same every time unless the limit
    cuts the search short. A large case may take a tenth longer than the limit, to have some bound to show.
    """
    start = time.monotonic()
    candidates = find_candidates(case, deadline=start + 0.4 * time_limit)
    cover = minimum_cover(candidates.covers, len(case.requirements), deadline=start + 0.9 * time_limit)
    layers, watches = drop_superfluous(case, [candidates.layers[i] for i in cover.chosen])
    assignment = name_layers(case, layers, watches)
    last = max(start + time_limit, time.monotonic() + time_limit / 10)
    certificate = build_certificate(case, candidates, cover, deadline=last)
    if found := find_breaches(case, assignment):
        raise RuntimeError(f"the planner's own mistake, please report it: {found[0]}")
    return LayerPlan(
        case,
        assignment,
        max(cover.bound if candidates.is_complete else 0, certificate.bound),
        certificate,
        len(candidates.layers),
        time.monotonic() - start,
    )


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
