"""The grid world: where moves lead, what they pay, and which maps it refuses."""

from __future__ import annotations

import pytest

from kit.learning.grid.grid_world import MOVE_NAMES, GridCell, GridMapError, GridRewards, GridWorld
from tests.cases import every_case

RIGHT, UP, LEFT, DOWN = range(len(MOVE_NAMES))
REWARDS = GridRewards(step=-1.0, target=5.0, small_target=2.0, cliff=-100.0)
WORLD = GridWorld(("g#G.", "S.C.", "...."), REWARDS)


@every_case(
    ("cell", "move", "reached", "reward", "terminated"),
    [
        ((1, 0), RIGHT, (1, 1), -1.0, False),
        ((2, 0), DOWN, (2, 0), -1.0, False),
        ((1, 1), UP, (1, 1), -1.0, False),
        ((1, 1), RIGHT, (1, 2), -100.0, True),
        ((1, 0), UP, (0, 0), 2.0, True),
        ((0, 3), LEFT, (0, 2), 5.0, True),
    ],
)
def test_a_move(
    cell: tuple[int, int], move: int, reached: tuple[int, int], reward: float, terminated: bool
) -> None:
    assert WORLD.step(GridCell(*cell), move) == (reached, reward, terminated)


def test_the_shortest_way_passes_neither_cliffs_nor_other_ends() -> None:
    assert WORLD.shortest_path_length == 7
    assert GridWorld(("SgG", "..."), REWARDS).shortest_path_length == 4


@every_case(
    ("rows", "said"),
    [
        ((), "the same length"),
        (("SG", "."), "the same length"),
        (("S?G",), r"'\?'"),
        (("..G",), "one start"),
        (("S..",), "target"),
        (("SCG",), "no path"),
        (("S" + "." * 500 + "G",), "at most"),
    ],
)
def test_a_map_that_is_none_says_why(rows: tuple[str, ...], said: str) -> None:
    with pytest.raises(GridMapError, match=said):
        GridWorld(rows)
