"""The contracts of what takes part in a lock-step run: participants exchange messages, observers watch the steps."""

from __future__ import annotations

from collections.abc import Collection
from typing import TYPE_CHECKING, Any, Final, Protocol

from kit.ros.graph.graph import Graph

if TYPE_CHECKING:  # a launch without a world must not load the physics
    from kit.sim.simulation import Simulation

MAX_ROUNDS: Final = 100
"""Rounds of exchange between nodes and participants within one tick; what is left is delivered in the next."""


class Participant(Protocol):
    """Nodes of another process, or anything else that exchanges messages with the graph in each tick."""

    def exchange(self) -> bool:
        """Sends what is due and receives what came back; false when nothing was due."""


class ClosableParticipant(Participant, Protocol):
    """A participant that is opened for a run and closed at its end: a server for other terminals, a bag."""

    def close(self) -> None: ...


class Observer:
    """Hooks that a runner calls; every one does nothing unless it is overridden."""

    def on_message(self, topic: str, message: Any) -> None:
        """A message is about to reach the devices that subscribe to ``topic``."""

    def on_service(self, service: str, *arguments: Any) -> None:
        """A service has changed the world, see ``kit.sim.simulation.SERVICES``."""

    def on_step(self, simulation: Simulation) -> None:
        """The simulation has made a step."""


def exchange_until_idle(graph: Graph, participants: Collection[Participant]) -> None:
    """Runs callbacks and exchanges messages until nothing is due, so that a key reaches the wheels within the tick."""
    for _ in range(MAX_ROUNDS):
        graph.run_due()
        if not participants or not sum(
            each.exchange() for each in participants
        ):  # every one of them, so no any()
            return
