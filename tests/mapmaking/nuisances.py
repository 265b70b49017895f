"""What else is on paper than walls, for photographs of drawings: rules, squares, folds, writing, measures, slips of the pen.

Sizes are those of real paper at the scale of ``photos``: 5 m on 297 mm, so that a millimetre is 17 mm of the world. The
ranges were fixed before the reader knew of any of them. What is drawn here is no wall, but for a room without a door.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, Final, TypeAlias

import numpy as np
from PIL import Image, ImageDraw, ImageFilter, ImageFont

from kit.arrays import FloatArray

MM: Final = 5.0 / 297.0
"""A millimetre of paper [m]."""
RULE_WIDTH: Final = (0.2, 0.4)
"""[mm]"""
RULE_DARKNESS: Final = (0.08, 0.3)
RULES_APART: Final = (7.0, 10.0)
"""[mm]"""
SQUARES_APART: Final = (4.0, 10.0)
"""[mm]"""
FOLDS: Final = (1, 3)
CREASES: Final = (8, 25)
FOLD_WIDTH: Final = (0.6, 2.5)
"""[mm]"""
FOLD_DARKNESS: Final = (0.08, 0.35)
WORDS: Final = ("Kitchen", "Bed 3.2 m", "Hall", "Living room", "WC", "Table", "Door", "A 12", "Bath 2.1 m")
WORD_COUNT: Final = (2, 5)
LETTER_HEIGHT: Final = (4.0, 9.0)
"""[mm]"""
MEASURES: Final = (1, 3)
THIN_PEN: Final = (0.3, 0.7)
"""Width of writing and measures, as a share of the walls'."""
SLIPS: Final = (2, 6)
SLIP_LENGTH: Final = (6.0, 20.0)
"""[mm]"""
CLEAR: Final = 0.12
"""What is written or slips keeps this far from walls [m]."""
ROOM_SIDE: Final = (0.7, 1.3)
"""[m]"""

Wall: TypeAlias = tuple[tuple[float, float], tuple[float, float]]


class Sheet:
    """A sheet to draw a nuisance on, in metres from its lower left corner; ``share`` is where ink or shade is."""

    def __init__(self, size: tuple[float, float], scale: int) -> None:
        self.size, self.scale = size, scale
        self.image = Image.new("L", (round(size[0] * scale), round(size[1] * scale)), 0)
        self.draw = ImageDraw.Draw(self.image)

    def at(self, x: float, y: float) -> tuple[float, float]:
        """The pixel of a place [m]."""
        return x * self.scale, self.image.size[1] - y * self.scale

    def line(self, points: Any, width: float) -> None:
        """A line through places [m]; ``width`` [m]."""
        self.draw.line(
            [self.at(*point) for point in points], fill=255, width=max(1, round(width * self.scale))
        )

    def shade(self, darkness: float, soft: float = 0.0) -> FloatArray:
        """(rows, columns) the share of the paper's light that is left. ``soft``: blurred by so much [m]."""
        image = self.image.filter(ImageFilter.GaussianBlur(soft * self.scale)) if soft else self.image
        share = np.asarray(image, dtype=float) / 255.0
        if soft:
            share /= max(float(share.max()), 1e-9)
        return np.asarray(1.0 - darkness * share)


def ruled(
    sheet: Sheet, walls: list[Wall], pen: tuple[float, float], random: np.random.Generator
) -> FloatArray:
    """Lines across the paper."""
    _rules(sheet, random.uniform(*RULES_APART) * MM, random, both=False)
    return sheet.shade(random.uniform(*RULE_DARKNESS))


def squared(
    sheet: Sheet, walls: list[Wall], pen: tuple[float, float], random: np.random.Generator
) -> FloatArray:
    """Squares all over the paper."""
    _rules(sheet, random.uniform(*SQUARES_APART) * MM, random, both=True)
    return sheet.shade(random.uniform(*RULE_DARKNESS))


def folded(
    sheet: Sheet, walls: list[Wall], pen: tuple[float, float], random: np.random.Generator
) -> FloatArray:
    """Folds from edge to edge, as of a sheet that was in an envelope."""
    width, height = sheet.size
    for _ in range(int(random.integers(FOLDS[0], FOLDS[1] + 1))):
        place, lean = random.uniform(0.25, 0.75), random.uniform(-0.05, 0.05)
        ends = (
            ((0.0, place * height), (width, (place + lean) * height))
            if random.random() < 0.5
            else ((place * width, 0.0), ((place + lean) * width, height))
        )
        sheet.line(ends, random.uniform(*FOLD_WIDTH) * MM)
    return sheet.shade(random.uniform(*FOLD_DARKNESS), soft=0.5 * MM)


def crumpled(
    sheet: Sheet, walls: list[Wall], pen: tuple[float, float], random: np.random.Generator
) -> FloatArray:
    """Creases in all directions, as of a sheet that was a ball."""
    for _ in range(int(random.integers(CREASES[0], CREASES[1] + 1))):
        x, y = random.uniform(0, sheet.size[0]), random.uniform(0, sheet.size[1])
        angle, length = random.uniform(0, math.tau), random.uniform(0.3, 1.5)
        middle = (x + 0.5 * length * math.cos(angle), y + 0.5 * length * math.sin(angle))
        bent = angle + random.normal(0, 0.2)
        end = (middle[0] + 0.5 * length * math.cos(bent), middle[1] + 0.5 * length * math.sin(bent))
        sheet.line(((x, y), middle, end), random.uniform(*FOLD_WIDTH) * MM)
    return sheet.shade(random.uniform(*FOLD_DARKNESS), soft=0.5 * MM)


def written(
    sheet: Sheet, walls: list[Wall], pen: tuple[float, float], random: np.random.Generator
) -> FloatArray:
    """Names of rooms, in the walls' pen or a thinner one."""
    height = random.uniform(*LETTER_HEIGHT) * MM
    font = ImageFont.load_default(round(1.4 * height * sheet.scale))
    bold = round(0.5 * random.uniform(*THIN_PEN) * pen[0] * sheet.scale)
    for _ in range(int(random.integers(WORD_COUNT[0], WORD_COUNT[1] + 1))):
        text = str(random.choice(WORDS))
        length = font.getlength(text) / sheet.scale
        found = _free_place(sheet, walls, length, height, random)
        if found is not None:
            sheet.draw.text(sheet.at(*found), text, fill=255, font=font, anchor="ls", stroke_width=bold)
    return sheet.shade(pen[1])


def measured(
    sheet: Sheet, walls: list[Wall], pen: tuple[float, float], random: np.random.Generator
) -> FloatArray:
    """Dimension lines with arrows and numbers, in a thinner pen."""
    width = max(0.006, random.uniform(*THIN_PEN) * pen[0])
    font = ImageFont.load_default(round(0.1 * sheet.scale))
    for _ in range(int(random.integers(MEASURES[0], MEASURES[1] + 1))):
        length = random.uniform(0.6, 2.2)
        found = _free_place(sheet, walls, length, 0.16, random)
        if found is None:
            continue
        x, y = found
        sheet.line(((x, y), (x + length, y)), width)
        for end, way in ((x, 1), (x + length, -1)):
            for side in (0.04, -0.04):
                sheet.line(((end, y), (end + way * 0.07, y + side)), width)
        sheet.draw.text(
            sheet.at(x + length / 2, y + 0.04), f"{length:.2f} m", fill=255, font=font, anchor="ms"
        )
    return sheet.shade(pen[1])


def slipped(
    sheet: Sheet, walls: list[Wall], pen: tuple[float, float], random: np.random.Generator
) -> FloatArray:
    """Short strokes that belong to nothing, in the walls' pen."""
    for _ in range(int(random.integers(SLIPS[0], SLIPS[1] + 1))):
        length = random.uniform(*SLIP_LENGTH) * MM
        found = _free_place(sheet, walls, length, length, random)
        if found is not None:
            angle = random.uniform(0, math.pi / 2)
            end = (found[0] + length * math.cos(angle), found[1] + length * math.sin(angle))
            sheet.line((found, end), pen[0])
    return sheet.shade(pen[1])


NUISANCES: Final[
    dict[str, Callable[[Sheet, list[Wall], tuple[float, float], np.random.Generator], FloatArray]]
] = {
    "ruled": ruled,
    "squared": squared,
    "folded": folded,
    "crumpled": crumpled,
    "written": written,
    "measured": measured,
    "slipped": slipped,
}
"""By name: each gives (rows, columns) the share of the paper's light that is left. ``pen``: width [m] and darkness of the walls'."""

CLOSED: Final = "closed room"
"""A nuisance of another kind: walls that are true, around a room that nobody can enter."""
KINDS: Final = (*NUISANCES, CLOSED)


def closed_room(walls: list[Wall], size: tuple[float, float], random: np.random.Generator) -> list[Wall]:
    """The walls of a room without a door, where there is a place for it; else none."""
    sheet = Sheet(size, 100)
    side = (random.uniform(*ROOM_SIDE), random.uniform(*ROOM_SIDE))
    found = _free_place(sheet, walls, side[0], side[1], random, clear=0.4)
    if found is None:
        return []
    x, y = found
    corners = [(x, y), (x + side[0], y), (x + side[0], y + side[1]), (x, y + side[1])]
    return [(corners[k], corners[(k + 1) % 4]) for k in range(4)]


def _rules(sheet: Sheet, apart: float, random: np.random.Generator, *, both: bool) -> None:
    width = random.uniform(*RULE_WIDTH) * MM
    for y in np.arange(random.uniform(0, apart), sheet.size[1], apart):
        sheet.line(((0.0, y), (sheet.size[0], y)), width)
    for x in np.arange(random.uniform(0, apart), sheet.size[0], apart) if both else ():
        sheet.line(((x, 0.0), (x, sheet.size[1])), width)


def _free_place(
    sheet: Sheet,
    walls: list[Wall],
    width: float,
    height: float,
    random: np.random.Generator,
    clear: float = CLEAR,
) -> tuple[float, float] | None:
    """The lower left corner of a box that keeps clear of all walls and of what is drawn already [m]; None: none was found."""
    for _ in range(200):
        x = random.uniform(0.3, sheet.size[0] - 0.3 - width)
        y = random.uniform(0.3, sheet.size[1] - 0.3 - height)
        box = (x - clear, y - clear, x + width + clear, y + height + clear)
        (left, low), (right, high) = sheet.at(*box[:2]), sheet.at(*box[2:])
        is_blank = not np.asarray(
            sheet.image.crop((round(left), round(high), round(right), round(low)))
        ).any()
        if is_blank and not any(_crosses(wall, box) for wall in walls):
            return x, y
    return None


def _crosses(wall: Wall, box: tuple[float, float, float, float]) -> bool:
    """Whether a wall enters a box."""
    shares = np.linspace(0, 1, 60)
    x = wall[0][0] + shares * (wall[1][0] - wall[0][0])
    y = wall[0][1] + shares * (wall[1][1] - wall[0][1])
    return bool(((x > box[0]) & (x < box[2]) & (y > box[1]) & (y < box[3])).any())
