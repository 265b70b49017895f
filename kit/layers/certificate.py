"""Why there can be no fewer layers, in a form that a person can check.

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

from kit.layers.candidates import Candidates
from kit.layers.cover import Cover
from kit.layers.requirements import Case, Requirement, fit_together

Weights = Mapping[Requirement, Fraction]


@dataclass(frozen=True, slots=True)
class Certificate:
    """A lower bound on the number of layers, with its reasons.

    ``bound`` = len(apart) + the sum of the weights of each part, rounded up.
    """

    apart: tuple[Requirement, ...]
    """Requirements of which no two fit one layer."""
    parts: tuple[Weights, ...] = ()
    """Weights, of which no layer collects more than 1; no layer serves two parts, nor a part and one ``apart``."""

    @property
    def bound(self) -> int:
        return len(self.apart) + sum(math.ceil(sum(part.values())) for part in self.parts)


def certificate_of(
    case: Case, candidates: Candidates, cover: Cover, *, deadline: float = math.inf
) -> Certificate:
    """The reasons a cover came with, as requirements; only those that hold when they are checked afresh.

    ``candidates`` must be complete for the weights to count; without them a packing that ``greedily_apart``
    finds takes their place.
    """
    if candidates.complete:
        found = Certificate(
            tuple(case.requirements[row] for row in cover.packed),
            tuple(
                {case.requirements[row]: weight for row, weight in part.items()} for part in cover.weighted
            ),
        )
        if holds(case, candidates, found):
            return found
    return greedily_apart(case, deadline=deadline)


def holds(case: Case, candidates: Candidates, certificate: Certificate) -> bool:
    """Whether the certificate is what it claims to be, by the definitions alone."""
    pairs = combinations(certificate.apart, 2)
    if any(fit_together(case, one, other) is None for one, other in pairs):
        return False
    if not certificate.parts:
        return True
    parts = [{requirement: Fraction(1)} for requirement in certificate.apart] + list(certificate.parts)
    number = {requirement: i for i, requirement in enumerate(case.requirements)}
    weight = {number[r]: (part, value) for part, weights in enumerate(parts) for r, value in weights.items()}
    if len(weight) < sum(map(len, parts)) or any(value < 0 for _, value in weight.values()):
        return False  # something is counted twice
    for served in candidates.covers:
        counted = [weight[row] for row in served if row in weight]
        if len({part for part, _ in counted}) > 1 or sum(value for _, value in counted) > 1:
            return False
    return True


def greedily_apart(case: Case, *, deadline: float = math.inf) -> Certificate:
    """Requirements of which no two fit one layer, found one after the other; often not the most there are."""
    chosen: list[Requirement] = []
    for requirement in case.requirements:
        if time.monotonic() > deadline:
            break
        if all(fit_together(case, requirement, other) is not None for other in chosen):
            chosen.append(requirement)
    return Certificate(tuple(chosen))
