"""The layers worth considering: maximal cliques, once for every set of lasers that may watch them.

Write G for the graph whose vertices are the entities and whose edges are the pairs that may share a layer
(``collide`` and ``either``), and, for a set T of lasers, W_T for the entities to which no laser of T must be
blind (W of no lasers: all of them). A layer watched by exactly the lasers T is a clique of G inside W_T; and
adding to it any further vertex that keeps it so breaks nothing and serves more. Therefore some optimal plan
uses maximal cliques of the graphs G[W_T] only, each watched by every laser that may watch it, and finding the
fewest layers is a *set cover*: rows are the requirements, columns these cliques K, and K covers

    a contact (a, b)    when a and b are in K,
    a sighting (l, v)   when v is in K and l must be blind to nothing in K.

With no lasers, this is the classical reduction of the edge clique cover problem, which is NP-hard; at most
n*n/4 cliques are ever needed (Erdos, Goodman and Posa 1966), with equality for K_{n/2,n/2}: so eight
entities always fit Flatland's sixteen layers, and nine may not.

Complexity: a graph of n vertices has up to 3^(n/3) maximal cliques (Moon and Moser 1965), which networkx lists
in time proportional to that bound; there are up to 2^L sets W_T for L lasers, but lasers with equal blind sets
share theirs, and equal sets are searched once. Hence the limit and the deadline.

References
    P. Erdos, A. W. Goodman, L. Posa. The representation of a graph by set intersections. Canadian J. of
        Mathematics 18 (1966). doi:10.4153/CJM-1966-014-3
    J. W. Moon, L. Moser. On cliques in graphs. Israel J. of Mathematics 3 (1965). doi:10.1007/BF02760024
    E. Tomita, A. Tanaka, H. Takahashi. The worst-case time complexity for generating all maximal cliques.
        Theoretical Computer Science 363 (2006), as in networkx. doi:10.1016/j.tcs.2006.06.015
"""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from kit.layers.requirements import (
    ContactRequirement,
    LayerCase,
    Requirement,
    SightRequirement,
    required_entities,
)

if TYPE_CHECKING:
    import networkx

LayerMembers = frozenset[str]

MAX_VISIBLE_SETS = 4096
"""More sets W_T than this are not searched: twelve lasers of quite different needs."""

_CLOCK_INTERVAL = 256


@dataclass(frozen=True, slots=True)
class CandidateLayers:
    """The columns of the cover: ``covers[i]`` are the rows (numbers of requirements) that ``layers[i]`` serves."""

    layers: tuple[LayerMembers, ...]
    covers: tuple[frozenset[int], ...]
    is_complete: bool
    """False: the search was cut short, so a cover by these layers is a plan but its optimality proves nothing."""


def sharing_graph(case: LayerCase) -> networkx.Graph[str]:
    """G: an edge where two entities may share a layer. Without the entities that may be in no layer at all."""
    import networkx

    graph: networkx.Graph[str] = networkx.Graph()
    graph.add_nodes_from(name for name in case.names if case.relation(name, name) != "apart")
    order = {name: i for i, name in enumerate(case.names)}
    graph.add_edges_from(
        (name, other)
        for name in graph
        for other in sorted(case.may_share[name], key=order.__getitem__)
        if order[other] > order[name] and other in graph
    )
    return graph


def visible_sets(case: LayerCase) -> list[LayerMembers]:
    """Every distinct W_T, the largest first: the set of all entities, closed under taking out a laser's blind set.

    More than MAX_VISIBLE_SETS are a sign that they are not all there.
    """
    everything = frozenset(case.names)
    blind_sets = {case.blind_set(laser) for laser in case.lasers if laser.sees}
    found = {everything}
    # Invariant: ``found`` is closed under the blind sets looked at so far.
    for blind in sorted(blind_sets, key=lambda b: (len(b), sorted(b))):
        found |= {rest for seen in found if (rest := seen - blind)}
        if len(found) > MAX_VISIBLE_SETS:
            break
    return sorted((w for w in found if w), key=lambda w: (-len(w), sorted(w)))


def find_candidates(
    case: LayerCase, *, limit: int = 100_000, deadline: float = float("inf")
) -> CandidateLayers:
    """All candidate layers of the case, or as many as ``limit`` and ``deadline`` (of time.monotonic) allow.

    Even when cut short, every requirement is served by at least one of them.
    """
    graph = sharing_graph(case)
    rows = RequirementRows(case)
    found: dict[LayerMembers, frozenset[int]] = {}
    visible = visible_sets(case)
    complete = len(visible) <= MAX_VISIBLE_SETS
    # Invariant: ``found`` holds every maximal clique of the graphs searched so far that serves something.
    for layer in _maximal_cliques(graph, visible, deadline):
        if layer is None or len(found) >= limit:
            complete = False
            break
        if layer not in found and (covers := rows.served_by(layer)):
            found[layer] = covers
    if not complete:
        served = set().union(*found.values())
        for layer in _cliques_for_rows(graph, case, rows, served):
            found[layer] = rows.served_by(layer)
    return CandidateLayers(tuple(found), tuple(found.values()), complete)


def _maximal_cliques(
    graph: networkx.Graph[str], visible: Iterable[LayerMembers], deadline: float
) -> Iterator[LayerMembers | None]:
    """The maximal cliques inside each of the sets, and a None at the end if the time was up before."""
    import networkx

    for seen in visible:
        if time.monotonic() > deadline:
            yield None
            return
        for count, clique in enumerate(networkx.find_cliques(graph.subgraph(seen).copy())):
            if count % _CLOCK_INTERVAL == 0 and time.monotonic() > deadline:
                yield None
                return
            yield frozenset(clique)


def _cliques_for_rows(
    graph: networkx.Graph[str], case: LayerCase, rows: RequirementRows, served: set[int]
) -> Iterator[LayerMembers]:
    """Layers for the requirements not ``served`` yet, one grown after the other until all are."""
    neighbours = {name: set(graph.adj[name]) for name in graph}
    joining = sorted(neighbours, key=lambda name: (-len(neighbours[name]), name))
    for row, requirement in enumerate(case.requirements):
        if row not in served:
            layer = _grow_clique(neighbours, joining, case, requirement)
            served |= rows.served_by(layer)
            yield layer


def _grow_clique(
    neighbours: Mapping[str, set[str]], joining: Sequence[str], case: LayerCase, requirement: Requirement
) -> LayerMembers:
    """One maximal layer that serves a requirement: its entities, then whoever fits, in the order of ``joining``."""
    layer = set(required_entities(requirement))
    blind = (
        case.blind_set(case.laser[requirement.laser])
        if isinstance(requirement, SightRequirement)
        else frozenset()
    )
    for name in joining:
        if name not in layer and name not in blind and layer <= neighbours[name]:
            layer.add(name)
    return frozenset(layer)


class RequirementRows:
    """The requirements, numbered, and which of them a layer serves."""

    def __init__(self, case: LayerCase) -> None:
        self._contacts: dict[str, list[tuple[str, int]]] = {}
        self._sights: list[tuple[LayerMembers, dict[str, int]]] = []
        sights: dict[str, dict[str, int]] = {}
        for row, requirement in enumerate(case.requirements):
            if isinstance(requirement, ContactRequirement):
                self._contacts.setdefault(requirement.a, []).append((requirement.b, row))
            else:
                sights.setdefault(requirement.laser, {})[requirement.entity] = row
        for laser, seen in sights.items():
            self._sights.append((case.blind_set(case.laser[laser]), seen))

    def served_by(self, layer: LayerMembers) -> frozenset[int]:
        """The rows a layer serves when every laser that may watch it does."""
        rows = [row for a in layer for b, row in self._contacts.get(a, ()) if b in layer]
        for blind, seen in self._sights:
            if layer.isdisjoint(blind):
                rows.extend(seen[name] for name in layer if name in seen)
        return frozenset(rows)
