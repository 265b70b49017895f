"""How the nodes of a graph and those of other processes take turns at one instant."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final, Protocol

from kit.ros.graph.graph import Graph

MAX_ROUNDS: Final = 100
"""Rounds of talk between nodes and guests within one tick; what is left goes on in the next."""


class Guest(Protocol):
    """Nodes that live in another process and take part in each tick."""

    def exchange(self) -> bool:
        """Hands over what is due and takes what comes back; false when nothing was due."""


class Companion(Guest, Protocol):
    """A guest that stays from a run's first tick to its last: a door, a bag."""

    def close(self) -> None: ...


def converse(graph: Graph, guests: Iterable[Guest]) -> None:
    """Lets nodes and guests talk until all is said, so that a key reaches the wheels within the tick."""
    for _ in range(MAX_ROUNDS):
        graph.run_due()
        if not sum(guest.exchange() for guest in guests):  # every one of them, so no any()
            return
