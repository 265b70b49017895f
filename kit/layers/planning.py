"""From a case to its plan: the fewest layers, the assignment, and the proof."""

from __future__ import annotations

import time
from dataclasses import dataclass

from kit.layers.assignment import Assignment, breaches, lean, named
from kit.layers.candidates import find_candidates
from kit.layers.certificate import Certificate, certificate_of
from kit.layers.cover import minimum_cover
from kit.layers.requirements import Case

DEFAULT_TIME_LIMIT = 10.0
"""Seconds."""


@dataclass(frozen=True, slots=True)
class Plan:
    """The layers found for a case, and what is known about how few there could be."""

    case: Case
    assignment: Assignment
    bound: int
    """Proved: no plan has fewer layers."""
    certificate: Certificate
    """The part of the proof that can be checked by hand; its own bound may be lower."""
    candidates: int
    """How many layers were considered."""
    seconds: float

    @property
    def size(self) -> int:
        return len(self.assignment.layers)

    @property
    def optimal(self) -> bool:
        return self.bound == self.size

    @property
    def gap(self) -> int:
        """How many layers fewer the unknown optimum could have."""
        return self.size - self.bound


def solve(case: Case, *, time_limit: float = DEFAULT_TIME_LIMIT) -> Plan:
    """The plan with the fewest layers, proved; or within ``time_limit`` [s] the best found, with bound and gap.

    At most 40 percent of the time goes to listing candidate layers. The plan is the same every time unless the limit
    cuts the search short. A large case may take a tenth longer than the limit, to have some bound to show.
    """
    start = time.monotonic()
    candidates = find_candidates(case, deadline=start + 0.4 * time_limit)
    cover = minimum_cover(candidates.covers, len(case.requirements), deadline=start + 0.9 * time_limit)
    layers, watches = lean(case, [candidates.layers[i] for i in cover.chosen])
    assignment = named(case, layers, watches)
    last = max(start + time_limit, time.monotonic() + time_limit / 10)
    certificate = certificate_of(case, candidates, cover, deadline=last)
    if found := breaches(case, assignment):
        raise RuntimeError(f"the planner's own mistake, please report it: {found[0]}")
    return Plan(
        case,
        assignment,
        max(cover.bound if candidates.complete else 0, certificate.bound),
        certificate,
        len(candidates.layers),
        time.monotonic() - start,
    )
