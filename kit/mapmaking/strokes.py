"""Finds the strokes of a drawing on a flattened sheet, whatever the light."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from PIL import Image, ImageFilter

from kit.arrays import BoolArray, FloatArray
from kit.mapmaking.doubts import PALE, JudgedStrokes, judge_strokes, usual_depth
from kit.mapmaking.pixels import (
    blurred,
    bridged,
    brightest_around,
    nearest_odd,
    without_thin_dark,
)
from kit.world.connected_parts import connected_parts

SHEET_PIXELS: Final = 1400
"""Width of the flat sheet in pixels."""

PLAN_PIXELS: Final = 1000
"""Width of the plan of walls in pixels."""

THICKEST_STROKE: Final = 0.022
"""Share of the sheet's width: a dark line wider than this is taken for a shadow."""

EDGE_MARGIN: Final = 0.006
"""Share of the sheet's width along each edge: anything darker there is the edge itself."""

NOISE_FACTOR: Final = 5.0
"""A stroke is darker than the paper by this many standard deviations of the paper's noise."""

NOISE_BLOCK: Final = 50
"""Side of the squares of flat sheet in which the noise is measured [pixels]."""

LEAST_DEPTH: Final = 0.07
"""And by this share of the paper's light."""

MOST_INK: Final = 0.17
"""More of a sheet than this is not walls alone: of drawings they take up to 0.11, printed squares as dark as the pen 0.22."""


class NoStrokes(ValueError):
    """The sheet holds no drawing; the message says what was found, and what helps."""


@dataclass(frozen=True, slots=True)
class StrokeOptions:
    """What counts as a stroke, as shares of the sheet's width."""

    widest_gap: float = 0.014
    """A break that is joined: 7 cm of 5 m."""
    least_length: float = 0.02
    """Anything shorter is a speck."""


def find_strokes(sheet: Image.Image, options: StrokeOptions = StrokeOptions()) -> JudgedStrokes:
    """The strokes of a flat sheet, ``PLAN_PIXELS`` columns wide. Raises NoStrokes."""
    depth = stroke_depth(sheet)
    mask = _stroke_pixels(depth)
    lifted = depth - float(np.median(depth))
    deep, _ = _plan_of(mask & (lifted > PALE * usual_depth(lifted, mask)), sheet, options)
    _check_share(deep)
    return judge_strokes(*_plan_of(mask, sheet, options), deep)


def _plan_of(mask: BoolArray, sheet: Image.Image, options: StrokeOptions) -> tuple[BoolArray, BoolArray]:
    """(rows, columns): the pixels of strokes as a plan, without specks and short breaks; and those of the breaks."""
    size = (PLAN_PIXELS, round(PLAN_PIXELS * sheet.height / sheet.width))
    plan = np.asarray(Image.fromarray((mask * 255).astype(np.uint8)).resize(size, Image.Resampling.BOX)) > 127
    plan = _without_specks(plan, 0.3 * options.least_length)
    # A line across a corner is no stroke: a stroke goes on for more than twice its width.
    whole = bridged(
        plan, nearest_odd(options.widest_gap * PLAN_PIXELS), nearest_odd(max(12.0, 2.5 * stroke_width(plan)))
    )
    return _without_specks(whole, options.least_length), whole & ~plan


def _check_share(plan: BoolArray) -> None:
    """Raises NoStrokes where there are hardly any strokes, or too many."""
    share = float(plan.mean())
    if share < 0.001:
        raise NoStrokes(
            "The sheet looks empty: it has no lines clearly darker than the paper. Draw with a darker pen."
        )
    if share > MOST_INK:
        raise NoStrokes(
            f"{100 * share:.0f} % of the sheet is dark, far more than walls drawn as lines: a picture with grey areas, or paper "
            "whose printed squares are nearly as dark as the pen. Draw the lines with a thick dark pen on plain paper."
        )


def stroke_width(mask: BoolArray) -> float:
    """The mean width of the strokes [pixels]: their area by half of their outline."""
    inner = mask.copy()
    inner[1:-1, 1:-1] &= mask[:-2, 1:-1] & mask[2:, 1:-1] & mask[1:-1, :-2] & mask[1:-1, 2:]
    outline = int(mask.sum()) - int(inner[1:-1, 1:-1].sum())
    return 2.0 * float(mask.sum()) / max(1, outline)


def stroke_depth(sheet: Image.Image) -> FloatArray:
    """(rows, columns): the share of the paper's light that is missing, 0 on paper and up to 1 in ink."""
    levels = np.asarray(sheet.convert("L"))
    small = (
        sheet.convert("L")
        .filter(ImageFilter.GaussianBlur(1.5))
        .resize((sheet.width // 4, sheet.height // 4), Image.Resampling.BOX)
    )
    paper = without_thin_dark(np.asarray(small), nearest_odd(THICKEST_STROKE * sheet.width / 4))
    even = Image.fromarray(blurred(paper.astype(float), 1.0).astype(np.float32)).resize(
        sheet.size, Image.Resampling.BICUBIC
    )
    light = blurred(levels.astype(float), 1.2)
    return np.asarray(1.0 - light / np.maximum(np.asarray(even, dtype=float), 1.0))


def _stroke_pixels(depth: FloatArray) -> BoolArray:
    """Half as deep as the strokes around are: so a blurred stroke keeps its width."""
    width = depth.shape[1]
    offset = float(np.median(depth))
    least = np.maximum(LEAST_DEPTH, NOISE_FACTOR * _noise(depth))
    lifted = np.clip(depth - offset, 0.0, 1.0)
    around = brightest_around((255 * lifted).astype(np.uint8), nearest_odd(0.012 * width)) / 255.0
    mask = lifted > np.maximum(0.6 * least, 0.5 * around)
    strokes = connected_parts(mask, across_corners=True)
    chosen = np.zeros(strokes.max() + 1, dtype=np.bool_)
    chosen[strokes[mask & (lifted > least)]] = True
    mask = chosen[strokes]
    margin = max(2, round(EDGE_MARGIN * width))
    mask[:margin] = mask[-margin:] = False
    mask[:, :margin] = mask[:, -margin:] = False
    return mask


def _noise(depth: FloatArray) -> FloatArray:
    """(rows, columns): the standard deviation of the paper around each pixel. In a shadow it is larger."""
    rows, columns = (length // NOISE_BLOCK for length in depth.shape)
    cut = depth[: rows * NOISE_BLOCK, : columns * NOISE_BLOCK]
    blocks = cut.reshape(rows, NOISE_BLOCK, columns, NOISE_BLOCK).swapaxes(1, 2).reshape(rows, columns, -1)
    spread = 1.4826 * np.median(np.abs(blocks - np.median(blocks, axis=-1, keepdims=True)), axis=-1)
    image = Image.fromarray(blurred(spread, 1.0).astype(np.float32))
    return np.asarray(image.resize(depth.shape[::-1], Image.Resampling.BILINEAR), dtype=float)


def _without_specks(mask: BoolArray, least: float) -> BoolArray:
    """The mask without the parts whose box has a diagonal shorter than ``least`` [share of the width]."""
    parts = connected_parts(mask, across_corners=True)
    sides = []
    for places in np.nonzero(mask):
        first, last = np.full(parts.max() + 1, max(mask.shape)), np.zeros(parts.max() + 1)
        np.minimum.at(first, parts[mask], places)
        np.maximum.at(last, parts[mask], places)
        sides.append(last - first + 1)
    is_kept = np.hypot(*sides) >= least * mask.shape[1]
    is_kept[0] = False
    kept: BoolArray = is_kept[parts]
    return kept
