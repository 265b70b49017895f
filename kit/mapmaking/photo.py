"""From a photograph of a drawing to a plan of walls: finds the sheet, flattens it, finds the strokes, sets the scale."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
from PIL import Image, ImageOps, UnidentifiedImageError

from kit.mapmaking.new_map import WallPlan
from kit.mapmaking.pixels import BoolArray, Corners, flattened
from kit.mapmaking.sheet import SheetNotFound, find_sheet, refine_corners
from kit.mapmaking.strokes import SHEET_PIXELS, NoStrokes, StrokeOptions, find_strokes

PAPER: Final = {"a4": math.sqrt(2), "letter": 11 / 8.5, "square": 1.0}
"""Longer side by shorter one."""
MAX_PIXELS: Final = 60_000_000
WORKING_WIDTH: Final = 1600
"""Pixels: larger photographs are made smaller first."""
SMALLEST_SIDE: Final = 300


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
    """Of the sheet in the photograph [pixels]."""


def open_photo(path: Path) -> Image.Image:
    """The photograph, upright. Raises PhotoError."""
    try:
        with Image.open(path) as image:
            if image.width * image.height > MAX_PIXELS:
                raise PhotoError(
                    f"{path} has {image.width} x {image.height} pixels. Make it smaller first, 4000 wide at most."
                )
            upright = ImageOps.exif_transpose(image).convert("RGB")
    except (UnidentifiedImageError, Image.DecompressionBombError, SyntaxError, ValueError) as error:
        if isinstance(error, PhotoError):
            raise
        raise PhotoError(f"{path} is no picture that can be read (JPEG, PNG and others can).") from None
    except OSError as error:
        raise PhotoError(f"{path}: {error.strerror or error}") from None
    if min(upright.size) < SMALLEST_SIDE:
        raise PhotoError(
            f"{path} has {upright.width} x {upright.height} pixels; at least {SMALLEST_SIDE} are needed each way."
        )
    return upright


def plan_from_photo(
    photo: Image.Image,
    scale: Scale,
    *,
    paper: float = PAPER["a4"],
    corners: Corners | None = None,
    are_rough: bool = False,
    options: StrokeOptions = StrokeOptions(),
) -> PhotoPlan:
    """The walls of a drawing. ``paper``: longer side of the sheet by its shorter one. ``corners`` [pixels]: of the sheet;
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
        used = np.flatnonzero(walls.any(axis=0))
        return scale.walls_width / int(used[-1] - used[0] + 1)
    if scale.sheet_width is None:
        raise PhotoError(
            "The scale is missing: say how wide the sheet is in the world (--width), or the walls (--walls-width)."
        )
    return scale.sheet_width / columns
