"""Lock-step of a graph with whoever exchanges messages with it."""

from __future__ import annotations

from kit.ros.graph.graph import Graph
from kit.run.lockstep import MAX_ROUNDS, exchange_until_idle


def test_participants_exchange_so_many_rounds_within_one_tick() -> None:
    graph = Graph(log_sink=lambda record: None)

    class Talker:
        def __init__(self, rounds: int) -> None:
            self.left = rounds
            self.rounds = 0

        def exchange(self) -> bool:
            self.rounds += 1
            self.left -= 1
            return self.left > 0

    for wanted, allowed in ((1, 1), (MAX_ROUNDS, MAX_ROUNDS), (MAX_ROUNDS + 1, MAX_ROUNDS)):
        talker = Talker(wanted)
        exchange_until_idle(graph, [talker])
        assert talker.rounds == allowed
