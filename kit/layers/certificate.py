"""Certificates: lower bounds on the number of layers that a person can check.

A certificate counts requirements of which no two fit one layer: ten such requirements need ten layers. Where no
such set is large enough, requirements are given weights so that no layer whatever collects more than 1: a total
weight of 7 1/2 needs eight layers. Both are checked here from the definitions, without the solver that found
them; only where neither reaches the optimum is the solver's exhaustive search all there is to go by.
"""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations

from kit.layers.candidates import CandidateLayers
from kit.layers.cover import SetCover
from kit.layers.requirements import LayerCase, Requirement, layer_conflict

RequirementWeights = Mapping[Requirement, Fraction]


@dataclass(frozen=True, slots=True)
class BoundCertificate:
    """A lower bound on the number of layers, with its reasons.

    ``bound`` = len(apart) + the sum of the weights of each part, rounded up.
    """

    conflicting: tuple[Requirement, ...]
    """Requirements of which no two fit one layer."""
    weighted_parts: tuple[RequirementWeights, ...] = ()
    """Weights, of which no layer collects more than 1; no layer serves two parts, nor a part and one ``apart``."""

    @property
    def bound(self) -> int:
        return len(self.conflicting) + sum(math.ceil(sum(part.values())) for part in self.weighted_parts)


def build_certificate(
    case: LayerCase, candidates: CandidateLayers, cover: SetCover, *, deadline: float = math.inf
) -> BoundCertificate:
    """The reasons a cover came with, as requirements; only those that hold when they are checked afresh.

    ``candidates`` must be complete for the weights to count; without them a packing that ``greedily_apart``
    finds takes their place.
    """
    if candidates.is_complete:
        found = BoundCertificate(
            tuple(case.requirements[row] for row in cover.packed_rows),
            tuple(
                {case.requirements[row]: weight for row, weight in part.items()} for part in cover.row_weights
            ),
        )
        if is_valid_certificate(case, candidates, found):
            return found
    return greedy_conflict_clique(case, deadline=deadline)


def is_valid_certificate(case: LayerCase, candidates: CandidateLayers, certificate: BoundCertificate) -> bool:
    """Returns whether the certificate is what it claims to be, by the definitions alone."""
    pairs = combinations(certificate.conflicting, 2)
    if any(layer_conflict(case, one, other) is None for one, other in pairs):
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
    """Returns a greedy clique of mutually conflicting requirements; often not a maximum one.

    Invariant: no two chosen requirements fit one layer. O(r^2) checks for r requirements."""
    chosen: list[Requirement] = []
    for requirement in case.requirements:
        if time.monotonic() > deadline:
            break
        if all(layer_conflict(case, requirement, other) is not None for other in chosen):
            chosen.append(requirement)
    return BoundCertificate(tuple(chosen))
