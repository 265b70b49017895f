"""Finds the sheet of paper in a photograph, and its corners to a fraction of a pixel."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import combinations
from typing import Final, cast

import numpy as np
from PIL import Image

from kit.arrays import BoolArray, FloatArray, Uint8Array
from kit.geometry import convex_hull
from kit.mapmaking.pixels import (
    Corners,
    blurred,
    crossing,
    line_through,
    without_thin_dark,
)
from kit.world.connected_parts import connected_parts

COARSE_WIDTH: Final = 400
"""Pixels of the width in which the sheet is looked for first."""

THICKEST_LINE: Final = 9
"""Dark lines thinner than this many coarse pixels are strokes, not the table."""

EDGES: Final = (0.3, 0.24, 0.19, 0.15, 0.12)
"""Change of the logarithm of the brightness from one coarse pixel to the next that counts as the sheet's edge, the
largest that encloses a sheet: a shadow's soft edge changes less."""

LEAST_AREA: Final = 0.1
"""Share of the photograph that a sheet fills at least."""

SAMPLES: Final = 90
"""Places on each side at which the edge is measured."""

LEAST_SEEN: Final = 0.6
"""Share of them at which it must be seen."""

LEAST_FALL: Final = 0.3
"""Share of the paper's brightness that is lost from the sheet to the table."""

REACH: Final = 14
"""Pixels on either side of a coarse edge in which the exact one is searched."""
WAY_OUT: Final = "Photograph the whole sheet on a darker table, evenly lit; or give its corners with --click or --corners (for a scan: --corners whole)."


class SheetNotFound(ValueError):
    """No sheet of paper is to be seen; the message says what was found instead, and what helps."""


def find_sheet(image: Image.Image) -> Corners:
    """The corners of the sheet that holds the photograph's middle [pixels]. Raises SheetNotFound."""
    levels = np.asarray(image.convert("L"))
    scale = max(1.0, image.width / COARSE_WIDTH)
    coarse = image.convert("L").resize(
        (round(image.width / scale), round(image.height / scale)), Image.Resampling.BOX
    )
    steps = _brightness_steps(np.asarray(coarse))
    reason = SheetNotFound()
    for edge in EDGES:
        try:
            rough = _quadrilateral(_region_in_the_middle(steps < edge))
            return _refined(levels, cast(Corners, tuple((x * scale, y * scale) for x, y in rough)))
        except SheetNotFound as error:
            reason = error
    raise reason


def _brightness_steps(levels: Uint8Array) -> FloatArray:
    """(rows, columns): how much the logarithm of the brightness changes to the next pixel; infinite at the rim."""
    light = np.log(blurred(without_thin_dark(levels, THICKEST_LINE).astype(float) + 4.0, 0.7))
    steps = np.zeros_like(light)
    steps[:, 1:-1] = np.abs(light[:, 2:] - light[:, :-2]) / 2
    steps[1:-1, :] = np.maximum(steps[1:-1, :], np.abs(light[2:, :] - light[:-2, :]) / 2)
    steps[[0, -1], :] = steps[:, [0, -1]] = np.inf
    return steps


def _region_in_the_middle(even: BoolArray) -> BoolArray:
    """The part of the even pixels that holds most of the picture's middle."""
    parts = connected_parts(even, across_corners=True)
    rows, columns = even.shape
    middle = parts[rows * 2 // 5 : rows * 3 // 5, columns * 2 // 5 : columns * 3 // 5]
    numbers, counts = np.unique(middle[middle > 0], return_counts=True)
    if not len(numbers):
        raise SheetNotFound(f"There is no paper in the middle of the picture. {WAY_OUT}")
    region = parts == numbers[np.argmax(counts)]
    share = region.mean()
    if share < LEAST_AREA:
        raise SheetNotFound(
            f"The object in the middle of the picture fills {100 * share:.0f} % of it; the sheet should fill more than {100 * LEAST_AREA:.0f} %. {WAY_OUT}"
        )
    box = np.argwhere(region)
    if (box.min(axis=0) <= 1).any() or (box.max(axis=0) >= np.array(region.shape) - 2).any():
        raise SheetNotFound(
            f"The sheet extends beyond the picture, or the table is as bright as the paper. {WAY_OUT}"
        )
    return np.asarray(region)


def _quadrilateral(region: BoolArray) -> list[tuple[float, float]]:
    """The largest quadrilateral with corners on the region's hull, from its upper left corner clockwise."""
    hull = np.array(convex_hull(_row_ends(region)))
    while len(hull) > 28:  # take out the corner that matters least
        before, after = np.roll(hull, 1, axis=0), np.roll(hull, -1, axis=0)
        areas = np.abs(_cross(hull - before, after - before))
        hull = np.delete(hull, int(np.argmin(areas)), axis=0)
    best, corners = 0.0, hull[:4]
    for chosen in combinations(range(len(hull)), 4):
        four = hull[list(chosen)]
        area = abs(float(_cross(four[2] - four[0], four[3] - four[1]))) / 2
        if area > best:
            best, corners = area, four
    whole = abs(float(_cross(hull, np.roll(hull, -1, axis=0)).sum())) / 2
    if best < 0.9 * whole:
        raise SheetNotFound(f"The object in the middle of the picture does not have four corners. {WAY_OUT}")
    return list(order_corners(corners.tolist()))


def order_corners(corners: Sequence[Sequence[float]]) -> Corners:
    """Four corners in any order: the upper left one first, then clockwise."""
    points = np.array(corners)
    x, y = (points - points.mean(axis=0)).T
    ordered = points[np.argsort(np.arctan2(y, x))]
    first = int(np.argmin(ordered.sum(axis=1)))
    return cast(Corners, tuple((float(x), float(y)) for x, y in np.roll(ordered, -first, axis=0)))


def refine_corners(image: Image.Image, rough: Corners) -> Corners:
    """The corners where the sheet's edges cross, if the edges are seen near the ``rough`` corners; else those."""
    try:
        return _refined(np.asarray(image.convert("L")), rough)
    except SheetNotFound:
        return rough


def _cross(one: FloatArray, other: FloatArray) -> FloatArray:
    return np.asarray(one[..., 0] * other[..., 1] - one[..., 1] * other[..., 0])


def _row_ends(region: BoolArray) -> list[tuple[float, float]]:
    """The first and the last pixel of each row: no other can be a corner of the hull."""
    rows = np.flatnonzero(region.any(axis=1))
    firsts = region[rows].argmax(axis=1)
    lasts = region.shape[1] - 1 - region[rows, ::-1].argmax(axis=1)
    ends = np.concatenate([np.column_stack([firsts, rows]), np.column_stack([lasts, rows])])
    return [(float(x), float(y)) for x, y in ends.tolist()]


def _refined(levels: Uint8Array, rough: Corners) -> Corners:
    """The corners from lines through exact edges, found along the rough ones."""
    light = blurred(levels.astype(float), 1.2)
    middle = np.mean(rough, axis=0)
    lines = []
    for number, begin in enumerate(rough):
        points = _edge_points(light, np.array(begin), np.array(rough[(number + 1) % 4]), middle)
        if len(points) < LEAST_SEEN * SAMPLES:
            side = ("upper", "right", "lower", "left")[number]
            raise SheetNotFound(f"The {side} edge of the sheet is hard to see. {WAY_OUT}")
        lines.append(line_through(points))
    corners = tuple(crossing(lines[number - 1], lines[number]) for number in range(4))
    if any(math.isnan(x) for corner in corners for x in corner):
        raise SheetNotFound(f"The sheet's edges do not meet in four corners. {WAY_OUT}")
    return cast(Corners, corners)


def _edge_points(light: FloatArray, begin: FloatArray, end: FloatArray, middle: FloatArray) -> FloatArray:
    """(n, 2): where the brightness falls most, going outwards across one side."""
    along = (end - begin) / np.linalg.norm(end - begin)
    outwards = np.array([along[1], -along[0]])
    if outwards @ (middle - begin) > 0:
        outwards = -outwards
    offsets = np.arange(-REACH, REACH + 1, dtype=float)
    found = []
    for share in np.linspace(0.04, 0.96, SAMPLES):
        place = begin + share * (end - begin)
        x = np.rint(place[0] + offsets * outwards[0]).astype(int)
        y = np.rint(place[1] + offsets * outwards[1]).astype(int)
        if x.min() < 0 or y.min() < 0 or x.max() >= light.shape[1] or y.max() >= light.shape[0]:
            continue
        fall = -np.diff(light[y, x])
        most = int(np.argmax(fall))
        near = slice(max(0, most - 3), most + 4)
        weight = np.clip(fall[near], 0, None)
        if weight.sum() < LEAST_FALL * light[y, x].max():
            continue
        offset = float((offsets[:-1][near] + 0.5) @ weight / weight.sum())
        found.append(place + offset * outwards + 0.5)  # a pixel's number is its left edge, not its middle
    return np.array(found).reshape(-1, 2)
