"""Search breadth first: what can be reached from a start, the nearest first, with the moves that lead there."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Hashable, Iterable, Iterator
from typing import TypeVar

Node = TypeVar("Node", bound=Hashable)
Move = TypeVar("Move")


def reached_from(
    start: Node, moves_from: Callable[[Node], Iterable[tuple[Move, Node]]]
) -> Iterator[tuple[Node, tuple[Move, ...]]]:
    """Yields the start and every node that can be reached from it, each once, with the fewest moves that lead there: of equally
    few those that ``moves_from`` gives first.

    >>> dict(reached_from(1, lambda number: [("double", 2 * number), ("one more", number + 1)] if number < 3 else []))
    {1: (), 2: ('double',), 4: ('double', 'double'), 3: ('double', 'one more')}
    """
    moves_to: dict[Node, tuple[Move, ...]] = {start: ()}
    waiting = deque([start])
    while waiting:
        node = waiting.popleft()
        yield node, moves_to[node]
        for move, following in moves_from(node):
            if following not in moves_to:
                moves_to[following] = (*moves_to[node], move)
                waiting.append(following)
