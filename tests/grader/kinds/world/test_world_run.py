"""The grid in which a way through a world is looked for."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from grader.kinds.world import world_run
from grader.kinds.world.world_run import CELL, MARGIN_CELLS, MAX_CELLS, search_path


@pytest.mark.parametrize("side", [MAX_CELLS * CELL - 1.0, MAX_CELLS * CELL, MAX_CELLS * CELL + 1.0, 7_777.7])
def test_a_large_world_has_no_larger_grid_and_its_way_is_found(
    side: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    sizes: list[int] = []
    measure = world_run.wall_distances

    def measured(x: Any, y: Any, *others: Any) -> Any:
        sizes.extend((len(x), len(y)))
        return measure(x, y, *others)

    monkeypatch.setattr(world_run, "wall_distances", measured)
    radius = side / 50
    length = side - 2 * radius  # the grid reaches a radius beyond the walls
    corners = np.array([(0.0, 0.0), (length, 0.0), (length, length / 9), (0.0, length / 9)])
    walls = np.hstack([corners, np.roll(corners, -1, axis=0)])
    middle = length / 18
    assert search_path(walls, (middle, middle), (length - middle, middle), radius) == (True, True)
    across = np.vstack([walls, [length / 2, 0.0, length / 2, length / 9]])
    assert search_path(across, (middle, middle), (length - middle, middle), radius) == (False, True)
    assert MAX_CELLS - 100 <= max(sizes) <= MAX_CELLS + 2 * MARGIN_CELLS + 1  # one more by rounding
