"""Search breadth first, compared with the lengths that networkx finds."""

from __future__ import annotations

import random

import networkx as nx

from kit.breadth_first import reached_from


def test_the_fewest_moves_to_every_node() -> None:
    for seed in range(30):
        graph = nx.gnp_random_graph(25, 0.08, seed=seed, directed=True)

        def moves_from(node: int, graph: nx.DiGraph = graph) -> list[tuple[tuple[int, int], int]]:
            return [((node, beside), beside) for beside in graph.successors(node)]

        reached = list(reached_from(0, moves_from))
        lengths = nx.single_source_shortest_path_length(graph, 0)
        assert {node: len(moves) for node, moves in reached} == dict(lengths)
        assert [len(moves) for _, moves in reached] == sorted(lengths.values())
        for node, moves in reached:
            at = 0
            for before, after in moves:
                assert before == at
                at = after
            assert at == node


def test_of_equally_few_moves_the_first_ones_count() -> None:
    def moves_from(node: tuple[int, int]) -> list[tuple[str, tuple[int, int]]]:
        x, y = node
        moves = [("right", (x + 1, y)), ("up", (x, y + 1))]
        return [(name, there) for name, there in moves if max(there) < 3]

    assert dict(reached_from((0, 0), moves_from))[2, 2] == ("right", "right", "up", "up")


def test_nothing_is_searched_before_it_is_asked_for() -> None:
    chance = random.Random(1)
    endless = reached_from(0, lambda number: [(chance.random(), number + 1)])
    assert [node for node, _ in (next(endless) for _ in range(4))] == [0, 1, 2, 3]
