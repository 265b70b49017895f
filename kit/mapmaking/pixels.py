"""Operations on arrays of pixels that Pillow does not have: perspective, blurring, closing along a direction.

Pillow and numpy alone: an image library would be the kit's largest dependency, for these few operations.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from kit.arrays import BoolArray, FloatArray, IndexArray, Uint8Array
from kit.world.connected_parts import connected_parts

Corners = tuple[tuple[float, float], tuple[float, float], tuple[float, float], tuple[float, float]]
"""Upper left, upper right, lower right, lower left [pixels], x to the right and y down."""


def blurred(values: FloatArray, radius: float) -> FloatArray:
    """The array, smoothed by a Gaussian of that standard deviation [pixels]; edges repeat."""
    reach = max(1, math.ceil(3.5 * radius))
    offsets = np.arange(-reach, reach + 1)
    weights = np.exp(-0.5 * (offsets / radius) ** 2)
    weights /= weights.sum()
    for axis in (0, 1):
        padded = np.pad(values, [(reach, reach) if each == axis else (0, 0) for each in (0, 1)], mode="edge")
        length = values.shape[axis]
        values = sum(
            weight * (padded[shift : shift + length] if axis == 0 else padded[:, shift : shift + length])
            for shift, weight in enumerate(weights.tolist())
        )
    return values


def without_thin_dark(levels: Uint8Array, size: int) -> Uint8Array:
    """The brightness without dark lines thinner than ``size`` [pixels, odd]: each place as bright as what is around."""
    return ~brightest_around(~brightest_around(levels, size), size)


def brightest_around(levels: Uint8Array, size: int) -> Uint8Array:
    """The largest value in a square of ``size`` pixels [odd] around each."""
    half = size // 2
    for axis in (0, 1):
        length = levels.shape[axis]
        values = np.pad(levels, [(half, half) if each == axis else (0, 0) for each in (0, 1)], mode="edge")
        values = values if axis == 0 else values.T
        reach = 1
        while reach < size:  # each round the windows grow, at most to twice their length
            step = min(reach, size - reach)
            values = np.maximum(values[:-step], values[step:])
            reach += step
        levels = values[:length] if axis == 0 else values[:length].T
    return levels


def nearest_odd(length: float) -> int:
    """The odd number of pixels nearest to a length: the size of a square about a pixel."""
    return 2 * round(length / 2) + 1


def grown(mask: BoolArray, size: int) -> BoolArray:
    """The mask with all pixels in a square of ``size`` (odd) around its own."""
    return np.asarray(brightest_around((mask * 255).astype(np.uint8), size | 1) > 0)


def homography(corners: Corners, width: float, height: float) -> FloatArray:
    """(3, 3): takes a rectangle of that size, in pixels from its upper left corner, to the four corners."""
    rectangle = ((0.0, 0.0), (width, 0.0), (width, height), (0.0, height))
    rows, values = [], []
    for (x, y), (u, v) in zip(rectangle, corners, strict=True):
        rows += [[x, y, 1, 0, 0, 0, -u * x, -u * y], [0, 0, 0, x, y, 1, -v * x, -v * y]]
        values += [u, v]
    solved = np.linalg.solve(np.array(rows, dtype=float), np.array(values, dtype=float))
    return np.append(solved, 1.0).reshape(3, 3)


def flattened(image: Image.Image, corners: Corners, size: tuple[int, int]) -> Image.Image:
    """The part of an image within four corners, seen straight from above, ``size`` (width, height) pixels large."""
    matrix = homography(corners, *size)
    return image.transform(
        size, Image.Transform.PERSPECTIVE, matrix.ravel()[:8].tolist(), Image.Resampling.BICUBIC
    )


def dilated_along_rows(mask: BoolArray, length: int) -> BoolArray:
    """Returns where the mask is true within ``length`` // 2 columns to either side."""
    return np.asarray(_window_sums(mask, length) > 0)


def eroded_along_rows(mask: BoolArray, length: int) -> BoolArray:
    """Returns where the mask is true in all of ``length`` columns around; beyond the edge it counts as true."""
    return np.asarray(_window_sums(~mask, length) == 0)


def _window_sums(mask: BoolArray, length: int) -> NDArray[np.int32]:
    half = length // 2
    sums = np.cumsum(np.pad(mask.astype(np.int32), ((0, 0), (half + 1, half))), axis=1, dtype=np.int32)
    return np.asarray(sums[:, 2 * half + 1 :] - sums[:, : -(2 * half + 1)])


def bridged(mask: BoolArray, gap: int, along: int, directions: int = 24) -> BoolArray:
    """The mask with its strokes joined over breaks of up to ``gap`` pixels, where they go straight on.

    In each of ``directions`` the strokes are taken that go that way for ``along`` pixels at least; what is missing
    between two of them is filled, and between one that is twice as long and whatever comes next. What has been joined is
    one stroke, which is joined to the next in its turn: a piece between two breaks is often too short alone. Corners and
    doors stay as they are: what lies across does not count, nor what is joined near by already.
    """
    result = mask.copy()
    windows = whole = [np.s_[0 : mask.shape[0], 0 : mask.shape[1]]]
    while windows:
        gaps = np.zeros_like(mask)
        for each in windows:
            gaps[each] |= _short_gaps(result[each], gap, along, directions)
        breaks = _breaks(result, gaps, gap)
        for rows, columns in breaks:
            result[rows, columns] = True
        around = [_window(mask, places, 4 * along + gap) for places in breaks]
        windows = around if sum(mask[each].size for each in around) < mask.size else whole
    return result


def _short_gaps(mask: BoolArray, gap: int, along: int, directions: int) -> BoolArray:
    """What is missing between strokes that go straight on, in any of ``directions``; see ``bridged``."""
    image = Image.fromarray((mask * 255).astype(np.uint8))
    result = np.zeros_like(mask)
    height, width = mask.shape
    for number in range(directions):
        angle = 180.0 * number / directions
        turned = np.asarray(image.rotate(angle, expand=True)) > 127
        strokes = dilated_along_rows(eroded_along_rows(turned, along), along) & turned
        if not strokes.any():
            continue
        strokes = grown(strokes, 5) & turned
        long_ones = dilated_along_rows(eroded_along_rows(turned, 2 * along), 2 * along) & turned
        added = _short_breaks(turned, strokes, long_ones, gap)
        if not added.any():
            continue
        back = Image.fromarray((added * 255).astype(np.uint8)).rotate(-angle, expand=True)
        left, top = (back.width - width) // 2, (back.height - height) // 2
        result |= np.asarray(back.crop((left, top, left + width, top + height))) > 127
    return result & ~mask


def _breaks(mask: BoolArray, gaps: BoolArray, around: int) -> list[tuple[IndexArray, IndexArray]]:
    """The rows and columns of each gap between pieces that are not joined within ``around`` pixels: no notch and no corner."""
    parts = connected_parts(gaps, across_corners=True)
    rows, columns = np.nonzero(parts)
    order = np.argsort(parts[rows, columns], kind="stable")
    cuts = np.flatnonzero(np.diff(parts[rows, columns][order])) + 1
    found = []
    for chosen in np.split(order, cuts) if len(order) else ():
        places = rows[chosen], columns[chosen]
        window = _window(mask, places, around)
        beside = grown(parts[window] == parts[places][0], 5) & mask[window]
        pieces = connected_parts(mask[window], across_corners=True)
        if len(np.unique(pieces[beside])) > 1:
            found.append(places)
    return found


def _window(mask: BoolArray, places: tuple[IndexArray, IndexArray], around: int) -> tuple[slice, slice]:
    """The part of a mask within ``around`` rows and columns of these places."""
    rows, columns = (slice(max(0, int(each.min()) - around), int(each.max()) + around + 1) for each in places)
    return rows, columns


def _short_breaks(mask: BoolArray, strokes: BoolArray, long_ones: BoolArray, gap: int) -> BoolArray:
    """Runs of up to ``gap`` missing pixels in a row, between two strokes or at the end of a long one."""
    edges = np.diff(np.pad(mask, ((0, 0), (1, 1))).astype(np.int8), axis=1)
    rows, ends = np.nonzero(edges == -1)  # the first missing pixel after a run
    next_rows, begins = np.nonzero(edges == 1)
    follows = np.searchsorted(next_rows * (mask.shape[1] + 2) + begins, rows * (mask.shape[1] + 2) + ends)
    known = follows < len(begins)
    rows, ends, follows = rows[known], ends[known], follows[known]
    near = (next_rows[follows] == rows) & (begins[follows] - ends <= gap)
    rows, ends, begins = rows[near], ends[near], begins[follows][near]
    joined = strokes[rows, ends - 1] & strokes[rows, begins]
    joined |= long_ones[rows, ends - 1] | long_ones[rows, begins]
    marks = np.zeros((mask.shape[0], mask.shape[1] + 1), dtype=np.int32)
    np.add.at(marks, (rows[joined], ends[joined]), 1)
    np.add.at(marks, (rows[joined], begins[joined]), -1)
    return np.asarray(np.cumsum(marks, axis=1)[:, :-1] > 0)


def line_through(points: FloatArray, rounds: int = 12) -> tuple[FloatArray, FloatArray]:
    """A point and a direction of the line through most of the points (n, 2): outliers lose their weight."""
    weights = np.ones(len(points))
    middle, direction = points.mean(axis=0), np.array([1.0, 0.0])
    for _ in range(rounds):
        middle = np.average(points, axis=0, weights=weights)
        offset = points - middle
        _, vectors = np.linalg.eigh((offset * weights[:, None]).T @ offset)
        direction = vectors[:, -1]
        aside = np.abs(offset @ np.array([-direction[1], direction[0]]))
        scale = max(0.5, 1.5 * float(np.median(aside)))
        weights = 1.0 / (1.0 + (aside / scale) ** 4)
    return middle, direction


def crossing(one: tuple[FloatArray, FloatArray], other: tuple[FloatArray, FloatArray]) -> tuple[float, float]:
    """Returns the point where two lines, each a point and a direction, meet; NaN where they are parallel."""
    matrix = np.column_stack([one[1], -other[1]])
    if abs(float(np.linalg.det(matrix))) < 1e-9:
        return math.nan, math.nan
    x, y = (one[0] + one[1] * np.linalg.solve(matrix, other[0] - one[0])[0]).tolist()
    return x, y
