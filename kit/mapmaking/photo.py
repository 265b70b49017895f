"""From a photograph of a drawing to a plan of walls: finds the sheet, flattens it, finds the strokes, sets the scale."""

from __future__ import annotations

import math
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path
from typing import Final, cast

import numpy as np
from PIL import Image, ImageFilter, ImageOps, UnidentifiedImageError

from kit.arrays import BoolArray, FloatArray, Uint8Array
from kit.geometry import convex_hull
from kit.mapmaking.new_map import WallPlan
from kit.mapmaking.pixels import (
    Corners,
    blurred,
    bridged,
    brightest_around,
    crossing,
    flattened,
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


SHEET_PIXELS: Final = 1400
"""Width of the flat sheet in pixels."""
PLAN_PIXELS: Final = 1000
"""Width of the plan of walls in pixels."""
THICKEST_STROKE: Final = 0.022
"""Share of the sheet's width: a dark line wider than this is taken for a shadow."""
EDGE_MARGIN: Final = 0.006
"""Share of the sheet's width along each edge: anything darker there is the edge itself."""
NOISE_FACTOR: Final = 5.0
"""A stroke is darker than the paper by so many standard deviations of the paper's noise."""
NOISE_BLOCK: Final = 50
"""Side of the squares of flat sheet in which the noise is measured [pixels]."""
LEAST_DEPTH: Final = 0.07
"""And by this share of the paper's light."""


class NoStrokes(ValueError):
    """The sheet holds no drawing; the message says what was found, and what helps."""


@dataclass(frozen=True, slots=True)
class StrokeOptions:
    """What counts as a stroke, as shares of the sheet's width."""

    widest_gap: float = 0.014
    """A break that is joined: 7 cm of 5 m."""
    least_length: float = 0.02
    """Anything shorter is a speck."""


def find_strokes(sheet: Image.Image, options: StrokeOptions = StrokeOptions()) -> BoolArray:
    """(rows, columns), ``PLAN_PIXELS`` columns: true where a stroke is. ``sheet``: flat. Raises NoStrokes."""
    depth = stroke_depth(sheet)
    mask = _stroke_pixels(depth)
    size = (PLAN_PIXELS, round(PLAN_PIXELS * sheet.height / sheet.width))
    plan = np.asarray(Image.fromarray((mask * 255).astype(np.uint8)).resize(size, Image.Resampling.BOX)) > 127
    plan = _without_specks(plan, 0.3 * options.least_length)
    # A line across a corner is no stroke: a stroke goes on for more than twice its width.
    plan = bridged(plan, _odd(options.widest_gap * PLAN_PIXELS), _odd(max(12.0, 2.5 * stroke_width(plan))))
    plan = _without_specks(plan, options.least_length)
    share = float(plan.mean())
    if share < 0.001:
        raise NoStrokes(
            "The sheet looks empty: it has no lines clearly darker than the paper. Draw with a darker pen."
        )
    if share > 0.3:
        raise NoStrokes(
            f"{100 * share:.0f} % of the sheet is dark: this does not look like lines on paper. Photograph a drawing of lines."
        )
    return plan


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
    paper = without_thin_dark(np.asarray(small), _odd(THICKEST_STROKE * sheet.width / 4))
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
    around = brightest_around((255 * lifted).astype(np.uint8), _odd(0.012 * width)) / 255.0
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


def _odd(length: float) -> int:
    return 2 * round(length / 2) + 1


PAPER: Final = {"a4": math.sqrt(2), "letter": 11 / 8.5, "square": 1.0}
"""Longer side by shorter one."""
MAX_PIXELS: Final = 60_000_000
WORKING_WIDTH: Final = 1600
"""Pixels: larger photographs are made smaller first."""
SMALLEST_SIDE: Final = 300
LEAST_CONTRAST: Final = 12
"""Smallest difference, of 255, between the brightest and the darkest parts of a photograph."""


class PhotoError(ValueError):
    """A photograph that cannot be read as a map; the message says why, and what helps."""


@dataclass(frozen=True, slots=True)
class Scale:
    """What a length on the sheet is in the world: one of the two is given."""

    sheet_width: float | None = None
    """The sheet's width [m]."""
    walls_width: float | None = None
    """From the outside of the leftmost wall to that of the rightmost one [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class PhotoPlan:
    """The walls that were found, and the flat sheet that they were found on."""

    plan: WallPlan
    sheet: Image.Image
    corners: Corners
    """Corners of the sheet in the photograph [pixels]."""

    @property
    def walls_width(self) -> float:
        """From the outside of the leftmost wall to that of the rightmost one [m]."""
        return _walls_columns(self.plan.walls) * self.plan.resolution


def open_photo(path: Path) -> Image.Image:
    """The photograph, upright. Raises PhotoError."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", Image.DecompressionBombWarning)  # the size is looked at below
            image = Image.open(path)
        with image:
            if image.width * image.height > MAX_PIXELS:
                raise PhotoError(
                    f"{path} has {image.width} x {image.height} pixels. Make it smaller first, 4000 wide at most."
                )
            upright = _in_colour(ImageOps.exif_transpose(image))
    except Image.DecompressionBombError:
        raise PhotoError(f"{path} has too many pixels. Make it smaller first, 4000 wide at most.") from None
    except (UnidentifiedImageError, SyntaxError, ValueError) as error:
        if isinstance(error, PhotoError):
            raise
        raise PhotoError(f"{path} is not a readable picture, such as JPEG or PNG.") from None
    except OSError as error:
        if error.errno is None:  # Pillow's own: a file that ends early, or is damaged
            raise PhotoError(f"{path}: {error}. Copy it again, or take another photograph.") from None
        raise PhotoError(f"{path}: {error.strerror}") from None
    if min(upright.size) < SMALLEST_SIDE:
        raise PhotoError(
            f"{path} has {upright.width} x {upright.height} pixels; each side needs at least {SMALLEST_SIDE}."
        )
    darkest, brightest = np.percentile(np.asarray(upright.convert("L").resize((200, 200))), (1, 99))
    if brightest - darkest < LEAST_CONTRAST:
        tone = "black" if brightest < 64 else "white" if darkest > 192 else "of one brightness"
        raise PhotoError(f"{path} is almost all {tone}: it shows nothing. Take another one, with more light.")
    return upright


def _in_colour(image: Image.Image) -> Image.Image:
    """Converts to red, green and blue with 8 bits each; transparent pixels become white."""
    if image.mode.startswith("I"):  # 16 bits a pixel, or 32: Pillow would cut them off
        levels = np.asarray(image).astype(float)
        image = Image.fromarray((levels * (255.0 / max(1.0, levels.max()))).astype(np.uint8))
    if image.has_transparency_data:
        white = Image.new("RGBA", image.size, "white")
        image = Image.alpha_composite(white, image.convert("RGBA"))
    return image.convert("RGB")


def plan_from_photo(
    photo: Image.Image,
    scale: Scale,
    *,
    paper: float = PAPER["a4"],
    corners: Corners | None = None,
    are_rough: bool = False,
    options: StrokeOptions = StrokeOptions(),
) -> PhotoPlan:
    """Finds the walls of a drawing in its photograph. ``paper``: longer side of the sheet by its shorter one. ``corners`` [pixels]: of the sheet;
    None: it is looked for. ``are_rough``: the corners were put by hand, and the sheet's edges are looked for near them.
    Raises PhotoError."""
    small = min(1.0, WORKING_WIDTH / photo.width)
    working = photo.resize(
        (round(photo.width * small), round(photo.height * small)), Image.Resampling.LANCZOS
    )
    try:
        found = find_sheet(working) if corners is None else _scaled(corners, small)
        if corners is not None and are_rough:
            found = refine_corners(working, found)
        size = _sheet_size(found, paper)
        sheet = flattened(working, found, size)
        walls = find_strokes(sheet, options)
    except (SheetNotFound, NoStrokes) as error:
        raise PhotoError(str(error)) from None
    resolution = _resolution(walls, scale)
    return PhotoPlan(WallPlan(walls, resolution), sheet, _scaled(found, 1 / small))


def whole_picture(photo: Image.Image) -> Corners:
    """The corners of the picture itself [pixels]: of a sheet that was scanned."""
    width, height = map(float, photo.size)
    return (0.0, 0.0), (width, 0.0), (width, height), (0.0, height)


def _scaled(corners: Corners, factor: float) -> Corners:
    one, two, three, four = ((x * factor, y * factor) for x, y in corners)
    return one, two, three, four


def _sheet_size(corners: Corners, paper: float) -> tuple[int, int]:
    """Pixels of the flat sheet: lying or upright, as it looks in the photograph."""
    (a, b, c, d) = corners
    across = math.dist(a, b) + math.dist(d, c)
    down = math.dist(a, d) + math.dist(b, c)
    ratio = paper if across >= down else 1 / paper
    return SHEET_PIXELS, round(SHEET_PIXELS / ratio)


def _resolution(walls: BoolArray, scale: Scale) -> float:
    columns = int(walls.shape[1])
    if scale.walls_width is not None:
        return scale.walls_width / _walls_columns(walls)
    if scale.sheet_width is None:
        raise PhotoError(
            "The scale is missing: give the width of the sheet in the world (--width), or of the walls (--walls-width)."
        )
    return scale.sheet_width / columns


def _walls_columns(walls: BoolArray) -> int:
    """The columns from the leftmost wall to the rightmost one."""
    used = np.flatnonzero(walls.any(axis=0))
    return int(used[-1] - used[0] + 1)
