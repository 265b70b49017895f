"""Plans the layers of a case: the fewest, with assignment and proof, or the ways out where Flatland has too few.

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

import time
from dataclasses import dataclass

from kit.layers.assignment import LayerAssignment, drop_superfluous, find_breaches, name_layers
from kit.layers.bound_certificates import BoundCertificate, build_certificate
from kit.layers.candidates import find_candidates
from kit.layers.cover import minimum_cover
from kit.layers.requirements import (
    LayerCase,
)

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
