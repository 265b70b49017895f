"""Lower bounds on the number of layers that a person can check."""

from __future__ import annotations

import math
import time
from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

from kit.layers.candidates import CandidateLayers
from kit.layers.cover import SetCover
from kit.layers.requirements import (
    LayerCase,
    Requirement,
    layer_conflict,
    required_entities,
)

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
