"""Small pictures of maps: every target stands on the floor, and its way is open in the picture too."""

from __future__ import annotations

import numpy as np
import pytest

from kit.breadth_first import reached_from
from kit.render.floor_plan import QUARTERS, floor_plan
from kit.school.game.levels import GameLevel
from kit.tui.screens.level_pictures import picture_of
from tests.kit_content import kit_levels

SIGNS = "S◎"


def quarters(picture: list[str]) -> dict[tuple[int, int], bool]:
    """Whether each quarter of a character is wall, by row and column of quarters."""
    return {
        (2 * y + part // 2, 2 * x + part % 2): sign not in SIGNS and bool(QUARTERS.index(sign) >> part & 1)
        for y, line in enumerate(picture)
        for x, sign in enumerate(line)
        for part in range(4)
    }


@pytest.mark.parametrize("rows", [5, 7])
@pytest.mark.parametrize("level", kit_levels(), ids=lambda each: each.id)
def test_the_way_to_every_target_is_open_in_a_small_picture(level: GameLevel, rows: int) -> None:
    picture = picture_of(level, 24, rows, "braille")
    assert [len(line) for line in picture] == [24] * rows
    walls = quarters(picture)
    signs = [(2 * y, 2 * x) for y, line in enumerate(picture) for x, sign in enumerate(line) if sign in SIGNS]
    assert len(signs) >= 2, "a start and a target"

    def ways(cell: tuple[int, int]) -> list[tuple[str, tuple[int, int]]]:
        y, x = cell
        beside = {"d": (y + 1, x), "u": (y - 1, x), "r": (y, x + 1), "l": (y, x - 1)}
        return [(move, there) for move, there in beside.items() if walls.get(there) is False]

    reached = {cell for cell, _ in reached_from(signs[0], ways)}
    assert all(sign in reached for sign in signs)


def test_a_room_is_drawn_with_its_walls_and_ascii_where_nothing_else_is() -> None:
    walls = np.array([[0, 0, 4, 0], [4, 0, 4, 2], [4, 2, 0, 2], [0, 2, 0, 0]], dtype=np.float64)
    signs = {(3.5, 1.0): "G", (0.5, 1.0): "S"}
    for ascii_only in (False, True):
        picture = floor_plan(walls, (0.5, 1.0), signs, 16, 6, ascii_only=ascii_only)
        text = "".join(picture)
        assert text.index("S") < text.index("G")
        assert (set(text) <= set("#SG ")) is ascii_only
        middle = next(line for line in picture if "S" in line)
        assert middle[middle.index("S") + 1 : middle.index("G")].strip() == ""
        assert middle.strip()[0] not in "SG"
        assert middle.strip()[-1] not in "SG"
