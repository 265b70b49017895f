"""Programs that talk with each other without a world: time goes on, and everybody has a turn."""

from __future__ import annotations

from kit.ros.graph.graph import Graph
from kit.run.lockstep import Participant, exchange_until_idle


class Worldless:
    """A graph and its guests, ticked as a runner ticks them."""

    def __init__(self, graph: Graph, step_size: float = 0.01) -> None:
        self.graph = graph
        self.step_size = step_size
        self.participants: list[Participant] = []

    def tick(self) -> None:
        """All that is due now; then time goes on by a step."""
        exchange_until_idle(self.graph, self.participants)
        self.graph.advance(self.graph.now_ns + round(self.step_size * 1e9))
