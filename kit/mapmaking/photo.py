"""From a photograph of a drawing to a plan of walls: finds the sheet, flattens it, finds the strokes, sets the scale."""

from __future__ import annotations

import math
import warnings
from collections.abc import Collection
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np
from PIL import Image, ImageOps, UnidentifiedImageError

from kit.arrays import BoolArray
from kit.mapmaking.doubts import JudgedStrokes
from kit.mapmaking.new_map import WallPlan
from kit.mapmaking.pixels import (
    Corners,
    flattened,
)
from kit.mapmaking.sheet import SheetNotFound, find_sheet, refine_corners
from kit.mapmaking.strokes import SHEET_PIXELS, NoStrokes, StrokeOptions, find_strokes
from kit.plain_files import read_plain_file
from kit.world.documents import UnusableFile
from kit.world.layer_reader import FORMATS, open_picture

PAPER: Final = {"a4": math.sqrt(2), "letter": 11 / 8.5, "square": 1.0}
"""Longer side by shorter one."""
MAX_PIXELS: Final = 60_000_000
MAX_PHOTO_BYTES: Final = 100_000_000
PHOTO_FORMATS: Final = (*FORMATS, "WEBP", "GIF", "TIFF")
"""Of one that Pillow reads as well, it has another program draw (PostScript)."""

WORKING_WIDTH: Final = 1600
"""Pixels: larger photographs are made smaller first."""
SMALLEST_SIDE: Final = 300

LEAST_CONTRAST: Final = 12
"""Smallest difference, of 255, between the brightest and the darkest parts of a photograph."""


class PhotoError(ValueError):
    """A photograph that cannot be read as a map; the message says why, and what helps."""


@dataclass(frozen=True, slots=True)
class PhotoScale:
    """What a length on the sheet is in the world: one of the two is given, else PhotoError."""

    sheet_width: float | None = None
    """The sheet's width [m]."""
    walls_width: float | None = None
    """From the outside of the leftmost wall to that of the rightmost one [m]."""

    def __post_init__(self) -> None:
        if (self.sheet_width is None) == (self.walls_width is None):
            raise PhotoError(
                "Give the size: --width METRES of the sheet, or --walls-width METRES between the outer walls."
            )

    def resolution(self, walls: BoolArray) -> float:
        """The side of a pixel [m]."""
        if self.walls_width is not None:
            return self.walls_width / _walls_columns(walls)
        assert self.sheet_width is not None  # one of the two is given
        return self.sheet_width / int(walls.shape[1])


@dataclass(frozen=True, slots=True, eq=False)
class PhotoPlan:
    """The walls that were found, and the flat sheet that they were found on."""

    scale: PhotoScale
    sheet: Image.Image
    corners: Corners
    """Corners of the sheet in the photograph [pixels]."""
    strokes: JudgedStrokes
    """All that was drawn, of which the plan has the walls."""

    @property
    def plan(self) -> WallPlan:
        """The walls to scale."""
        return WallPlan(self.strokes.walls, self.scale.resolution(self.strokes.walls))

    def keeping(self, kinds: Collection[str]) -> PhotoPlan:
        """A copy with the doubtful strokes of these kinds taken for walls."""
        return replace(self, strokes=self.strokes.keeping(kinds))

    @property
    def walls_width(self) -> float:
        """From the outside of the leftmost wall to that of the rightmost one [m]."""
        return _walls_columns(self.plan.walls) * self.plan.resolution


def open_photo(path: Path) -> Image.Image:
    """The photograph, upright. Raises PhotoError."""
    try:
        image = open_picture(read_plain_file(path, MAX_PHOTO_BYTES), PHOTO_FORMATS)
        with image:
            if image.width * image.height > MAX_PIXELS:
                raise PhotoError(
                    f"{path} has {image.width} x {image.height} pixels. Make it smaller first, 4000 wide at most."
                )
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # Pillow's own, of remarks in the file that are damaged
                upright = _in_colour(ImageOps.exif_transpose(image))
    except Image.DecompressionBombError:
        raise PhotoError(f"{path} has too many pixels. Make it smaller first, 4000 wide at most.") from None
    except UnusableFile as error:
        raise PhotoError(f"{path}: {error}.") from None
    except PhotoError:
        raise
    except OSError as error:
        if isinstance(error, UnidentifiedImageError):
            raise PhotoError(f"{path} is not a readable picture, such as JPEG or PNG.") from None
        if error.errno is None:  # Pillow's own: a file that ends early, or is damaged
            raise PhotoError(f"{path}: {error}. Copy it again, or take another photograph.") from None
        raise PhotoError(f"{path}: {error.strerror}") from None
    except Exception:  # noqa: BLE001 - Pillow's decoders raise whatever a broken file makes of them
        raise PhotoError(f"{path} is not a readable picture, such as JPEG or PNG.") from None
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
    scale: PhotoScale,
    *,
    paper: float = PAPER["a4"],
    corners: Corners | None = None,
    are_rough: bool = False,
    options: StrokeOptions = StrokeOptions(),
) -> PhotoPlan:
    """Finds the walls of a drawing in its photograph. ``paper``: longer side of the sheet by its shorter one. ``corners`` [pixels]: of the sheet;
    None: it is looked for. ``are_rough``: the corners were put by hand, and the sheet's edges are looked for near them.
    What may be no wall is left out; see ``PhotoPlan.keeping``. Raises PhotoError."""
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
        strokes = find_strokes(sheet, options)
    except (SheetNotFound, NoStrokes) as error:
        raise PhotoError(str(error)) from None
    return PhotoPlan(scale, sheet, _scaled(found, 1 / small), strokes)


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


def _walls_columns(walls: BoolArray) -> int:
    """The columns from the leftmost wall to the rightmost one."""
    used = np.flatnonzero(walls.any(axis=0))
    return int(used[-1] - used[0] + 1)
