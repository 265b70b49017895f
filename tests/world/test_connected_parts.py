"""Connected parts of a grid, along edges and across corners."""

from __future__ import annotations

import numpy as np

from kit.world.connected_parts import connected_parts


def flooded(mask: np.ndarray, *, across_corners: bool) -> np.ndarray:
    """The same, found place by place."""
    steps = [(dy, dx) for dy in (-1, 0, 1) for dx in (-1, 0, 1) if across_corners or not dy * dx]
    parts = np.zeros(mask.shape, dtype=int)
    for start in np.argwhere(mask).tolist():
        if parts[tuple(start)]:
            continue
        number, todo = parts.max() + 1, [tuple(start)]
        while todo:
            row, column = todo.pop()
            inside = 0 <= row < mask.shape[0] and 0 <= column < mask.shape[1]
            if inside and mask[row, column] and not parts[row, column]:
                parts[row, column] = number
                todo += [(row + dy, column + dx) for dy, dx in steps]
    return parts


def test_parts_and_their_numbers_are_those_of_a_flood() -> None:
    rng = np.random.default_rng(1)
    for shape in ((1, 1), (1, 9), (9, 1), (6, 7), (12, 15)):
        for share in (0.0, 0.3, 0.5, 0.7, 1.0):
            mask = rng.random(shape) < share
            for across in (False, True):
                found = connected_parts(mask, across_corners=across)
                assert (found == flooded(mask, across_corners=across)).all(), (mask, across)


def test_parts_are_joined_along_edges_and_not_across_corners() -> None:
    grid = np.array([[1, 0, 1], [1, 1, 0], [0, 0, 1]], dtype=bool)
    parts = connected_parts(grid)
    assert parts[0, 0] == parts[1, 0] == parts[1, 1]
    assert len(set(parts[grid].tolist())) == 3
    assert not parts[~grid].any()


def test_a_spiral_is_one_part() -> None:
    size = 41
    grid = np.zeros((size, size), dtype=bool)
    row = column = size // 2
    grid[row, column] = True
    direction, length = 0, 2
    while True:
        for _ in range(2):
            for _ in range(length):
                row += (0, 1, 0, -1)[direction]
                column += (1, 0, -1, 0)[direction]
                if not (0 <= row < size and 0 <= column < size):
                    parts = connected_parts(grid)
                    assert set(parts[grid].tolist()) == {1}
                    return
                grid[row, column] = True
            direction = (direction + 1) % 4
        length += 2
