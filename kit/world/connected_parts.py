"""Connected parts of a grid: which of its free places, pixels or dots hang together."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from kit.arrays import BoolArray, IndexArray


def connected_parts(mask: BoolArray, *, across_corners: bool = False) -> IndexArray:
    """Numbers the parts of a grid (rows, columns) in the order in which its rows reach them: 1, 2, ...; 0 where the mask is
    not set.

    Places are joined to the left, right, up and down, and ``across_corners`` diagonally too. Works on runs of set places,
    row by row: a grid of 100,000 places has some thousands of them.

    >>> connected_parts(np.array([[True, False, True], [True, True, False]])).tolist()
    [[1, 0, 2], [1, 1, 0]]
    """
    height, width = mask.shape
    padded = np.zeros((height, width + 2), dtype=np.int8)
    padded[:, 1:-1] = mask
    row, edge = np.nonzero(np.diff(padded, axis=1))
    rows, starts, stops = row[0::2], edge[0::2], edge[1::2]
    parent = list(range(len(rows)))

    def root(run: int) -> int:
        while parent[run] != run:
            parent[run] = parent[parent[run]]
            run = parent[run]
        return run

    first = np.searchsorted(rows, np.arange(height + 1)).tolist()
    start, stop = starts.tolist(), (stops + across_corners).tolist()
    for (above, here), (_, below) in pairwise(pairwise(first)):
        upper, lower = above, here
        while upper < here and lower < below:
            if start[upper] < stop[lower] and start[lower] < stop[upper]:
                one, other = root(upper), root(lower)
                parent[max(one, other)] = min(one, other)  # so that the root of a part is its first run
            if stop[upper] < stop[lower]:
                upper += 1
            else:
                lower += 1
    _, numbers = np.unique([root(run) for run in range(len(start))], return_inverse=True)
    # Each run raises the number from 0 at its start and lowers it at its end.
    steps = np.zeros((height, width + 1), dtype=np.intp)
    np.add.at(steps, (rows, starts), numbers + 1)
    np.add.at(steps, (rows, stops), -(numbers + 1))
    parts: IndexArray = np.cumsum(steps, axis=1)[:, :-1]
    return parts
