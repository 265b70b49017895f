"""Draws photographs of floor plans on paper, with known walls: tilted, in uneven light, with shadow, noise and grain.

The ranges below were fixed before the reader of photographs was written. A seed draws one photograph.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from io import BytesIO
from typing import Any, Final

import numpy as np
from PIL import Image, ImageDraw, ImageFilter

from kit.arrays import BoolArray, FloatArray
from tests.mapmaking.nuisances import CLOSED, NUISANCES, Sheet, closed_room

Points = tuple[tuple[float, float], ...]

SHEET: Final = (5.0, 5.0 / math.sqrt(2))
"""Width and height of what the sheet shows [m]: A4, across."""
PHOTO: Final = (1600, 1200)
"""Pixels of the photograph."""
PIXELS_PER_METRE: Final = 500
"""Of the sheet before it is photographed."""

TILT: Final = (0.0, 35.0)
"""Between the camera's axis and the sheet's normal [degrees]."""
ROLL: Final = (-8.0, 8.0)
"""About the camera's axis [degrees]."""
FILL: Final = (0.68, 0.9)
"""Share of the photograph's width or height that the sheet fills."""
FIELD_OF_VIEW: Final = (45.0, 70.0)
"""Of the camera, along its width [degrees]."""
SHADOW: Final = (0.0, 0.6)
"""Share of the light that a shadow takes away."""
PENUMBRA: Final = (20.0, 120.0)
"""Width of a shadow's soft edge [pixels]."""
GRADIENT: Final = (0.0, 0.3)
"""Share of the light lost from one side of the photograph to the other."""
NOISE: Final = (0.0, 10.0)
"""Standard deviation [grey levels of 256]."""
BLUR: Final = (0.0, 2.0)
"""Standard deviation [pixels]."""
GRAIN: Final = (0.0, 0.04)
"""Standard deviation of the paper's brightness, as a share."""
STROKE_WIDTH: Final = (0.015, 0.08)
"""[m]: 0.9 to 4.8 mm on A4 paper, from a pencil to a marker."""
STROKE_DARKNESS: Final = (0.4, 0.95)
"""Share of the paper's light that a stroke takes away: pencil to ink."""
GAPS: Final = (0, 4)
"""Number of breaks in the strokes."""
GAP_LENGTH: Final = (0.01, 0.05)
"""[m]"""
WOBBLE: Final = (0.0, 0.012)
"""How far a hand strays from a straight line [m]."""
DESK: Final = (0.12, 0.4)
"""Brightness of the desk, as a share of the paper's."""
JPEG_QUALITY: Final = (70, 95)
DOOR: Final = 0.4
"""Least distance between two walls that do not meet [m]."""
MARGIN: Final = 0.2
"""Between the outer walls and the sheet's edge [m]."""


@dataclass(frozen=True, slots=True)
class Photo:
    """A photograph and what is true of it."""

    seed: int
    image: Image.Image
    corners: Points
    """Of the sheet in the photograph [pixels]: upper left, upper right, lower right, lower left."""
    strokes: tuple[Points, ...]
    """The walls' middle lines, unbroken [m], x to the right and y up from the sheet's lower left corner."""
    stroke_width: float
    settings: dict[str, float]
    nuisance: str = ""
    """What else is on the paper, of ``nuisances.KINDS``; empty: nothing."""


def draw_photo(seed: int, nuisance: str = "") -> Photo:
    """The photograph of that seed, with this nuisance on its paper."""
    random = np.random.default_rng(seed)
    settings = {
        "tilt": random.uniform(*TILT),
        "roll": random.uniform(*ROLL),
        "fill": random.uniform(*FILL),
        "view": random.uniform(*FIELD_OF_VIEW),
        "shadow": random.uniform(*SHADOW),
        "noise": random.uniform(*NOISE),
        "blur": random.uniform(*BLUR),
        "grain": random.uniform(*GRAIN),
        "width": random.uniform(*STROKE_WIDTH),
        "darkness": random.uniform(*STROKE_DARKNESS),
        "wobble": random.uniform(*WOBBLE),
        "gaps": float(random.integers(GAPS[0], GAPS[1] + 1)),
        "desk": random.uniform(*DESK),
    }
    walls, own = draw_plan(random), np.random.default_rng([seed, 1])
    if nuisance == CLOSED:
        walls += closed_room(walls, SHEET, own)
    strokes = tuple(_by_hand(line, settings["wobble"], random) for line in walls)
    sheet = _draw_sheet(strokes, settings, random)
    if nuisance in NUISANCES:
        pen = settings["width"], settings["darkness"]
        left = NUISANCES[nuisance](Sheet(SHEET, PIXELS_PER_METRE), walls, pen, own)
        sheet = Image.fromarray(np.clip(np.asarray(sheet, dtype=float) * left, 0, 255).astype(np.uint8))
    to_photo = _camera(settings, random)
    width, height = sheet.size
    corners = _project(to_photo, np.array([(0, 0), (width, 0), (width, height), (0, height)], dtype=float))
    photo = _photograph(sheet, to_photo, settings, random)
    return Photo(
        seed,
        photo,
        tuple((float(x), float(y)) for x, y in corners),
        strokes,
        settings["width"],
        settings,
        nuisance,
    )


def draw_plan(random: np.random.Generator) -> list[tuple[tuple[float, float], tuple[float, float]]]:
    """Straight walls: a closed room, and 2 to 6 walls in it that leave doors."""
    low, high = (MARGIN, MARGIN), (SHEET[0] - MARGIN, SHEET[1] - MARGIN)
    corners = [(low[0], low[1]), (high[0], low[1]), (high[0], high[1]), (low[0], high[1])]
    walls = [(corners[index], corners[(index + 1) % 4]) for index in range(4)]
    wanted = int(random.integers(2, 7))
    for _ in range(200):
        if len(walls) >= 4 + wanted:
            break
        start = (random.uniform(low[0], high[0]), random.uniform(low[1], high[1]))
        angle = random.choice([0.0, math.pi / 2, math.pi, -math.pi / 2, random.uniform(-math.pi, math.pi)])
        length = random.uniform(0.5, 2.0)
        if random.random() < 0.5:  # begins at an outer wall
            start = (start[0], random.choice([low[1], high[1]]))
            angle = math.pi / 2 if start[1] == low[1] else -math.pi / 2
        end = (start[0] + length * math.cos(angle), start[1] + length * math.sin(angle))
        if _has_room((start, end), walls, low, high):
            walls.append((start, end))
    return walls


def true_mask(photo: Photo, pixels_per_metre: int) -> BoolArray:
    """(rows, columns): the strokes as they were meant, unbroken, with the top row first."""
    image = Image.new("L", (round(SHEET[0] * pixels_per_metre), round(SHEET[1] * pixels_per_metre)), 0)
    for stroke in photo.strokes:
        _draw_stroke(image, stroke, photo.stroke_width, pixels_per_metre, 255)
    return np.asarray(image) > 127


def _has_room(wall: Any, walls: list[Any], low: Any, high: Any) -> bool:
    """Whether a wall leaves a door to all others, but for the one that it begins at."""
    points = [
        (wall[0][0] + share * (wall[1][0] - wall[0][0]), wall[0][1] + share * (wall[1][1] - wall[0][1]))
        for share in np.linspace(0, 1, 21)
    ]
    if not all(
        low[0] - 1e-9 <= x <= high[0] + 1e-9 and low[1] - 1e-9 <= y <= high[1] + 1e-9 for x, y in points
    ):
        return False
    touching = [other for other in walls if _distance(points[0], other) < 1e-9]
    for other in walls:
        near = [point for point in points if _distance(point, other) < DOOR]
        if other in touching:
            if any(math.dist(point, points[0]) > 1.5 * DOOR for point in near):
                return False
        elif near:
            return False
    return True


def _distance(point: Any, wall: Any) -> float:
    (ax, ay), (bx, by) = wall
    length = (bx - ax) ** 2 + (by - ay) ** 2
    share = min(1.0, max(0.0, ((point[0] - ax) * (bx - ax) + (point[1] - ay) * (by - ay)) / length))
    return math.dist(point, (ax + share * (bx - ax), ay + share * (by - ay)))


def _by_hand(line: Any, wobble: float, random: np.random.Generator) -> Points:
    """A line as a hand draws it: smoothly beside the straight one, with its ends in place."""
    (ax, ay), (bx, by) = line
    length = math.hypot(bx - ax, by - ay)
    shares = np.linspace(0, 1, max(8, round(length / 0.1)))
    aside = np.zeros_like(shares)
    for wave in (1, 2, 3):
        aside += random.normal() * np.sin(math.pi * wave * shares) / wave
    largest = float(np.abs(aside).max())
    aside *= wobble / largest if largest else 0.0
    nx, ny = -(by - ay) / length, (bx - ax) / length
    return tuple(
        (float(ax + share * (bx - ax) + off * nx), float(ay + share * (by - ay) + off * ny))
        for share, off in zip(shares, aside, strict=True)
    )


def _draw_stroke(image: Image.Image, stroke: Points, width: float, scale: int, tone: int) -> None:
    draw, height = ImageDraw.Draw(image), image.size[1]
    points = [(x * scale, height - y * scale) for x, y in stroke]
    draw.line(points, fill=tone, width=max(1, round(width * scale)), joint="curve")
    radius = width * scale / 2
    for x, y in (points[0], points[-1]):
        draw.ellipse((x - radius, y - radius, x + radius, y + radius), fill=tone)


def _draw_sheet(
    strokes: tuple[Points, ...], settings: dict[str, float], random: np.random.Generator
) -> Image.Image:
    """The paper with its strokes, brightness 0 to 255, before any light falls on it."""
    scale = PIXELS_PER_METRE
    size = (round(SHEET[0] * scale), round(SHEET[1] * scale))
    ink = Image.new("L", size, 0)
    for stroke in strokes:
        _draw_stroke(ink, stroke, settings["width"], scale, 255)
    broken = ImageDraw.Draw(ink)
    for _ in range(round(settings["gaps"])):
        stroke = strokes[int(random.integers(len(strokes)))]
        at = int(random.integers(1, len(stroke) - 1))
        length, (x, y) = random.uniform(*GAP_LENGTH), stroke[at]
        dx, dy = stroke[at + 1][0] - stroke[at - 1][0], stroke[at + 1][1] - stroke[at - 1][1]
        along = math.hypot(dx, dy)
        dx, dy = dx / along * length / 2, dy / along * length / 2
        wide = 1.5 * settings["width"]
        nx, ny = -dy / (length / 2) * wide, dx / (length / 2) * wide
        corners = [
            (x - dx + nx, y - dy + ny),
            (x + dx + nx, y + dy + ny),
            (x + dx - nx, y + dy - ny),
            (x - dx - nx, y - dy - ny),
        ]
        broken.polygon([(a * scale, size[1] - b * scale) for a, b in corners], fill=0)
    share = np.asarray(ink, dtype=float) / 255
    pressure = _texture((size[1], size[0]), 3.0, random)  # a pencil skips over the paper's grain
    share *= np.clip(1 - 2.0 * settings["grain"] * np.abs(pressure), 0, 1)
    paper = 235 * (1 + settings["grain"] * _texture((size[1], size[0]), 1.5, random))
    return Image.fromarray(np.clip(paper * (1 - settings["darkness"] * share), 0, 255).astype(np.uint8))


def _texture(shape: tuple[int, int], smooth: float, random: np.random.Generator) -> FloatArray:
    """Random brightness of that shape, smoothed over ``smooth`` pixels, with standard deviation 1."""
    raw = random.integers(0, 256, size=shape, dtype=np.uint8)
    soft = np.asarray(Image.fromarray(raw).filter(ImageFilter.GaussianBlur(smooth)), dtype=float)
    return np.asarray((soft - soft.mean()) / soft.std())


def _camera(settings: dict[str, float], random: np.random.Generator) -> FloatArray:
    """(3, 3): from the sheet's pixels to the photograph's."""
    width, height = (round(side * PIXELS_PER_METRE) for side in SHEET)
    tilt, roll = math.radians(settings["tilt"]), math.radians(settings["roll"])
    about = random.uniform(0, math.tau)
    axis = np.array([math.cos(about), math.sin(about), 0.0])
    turn = _rotation(np.array([0.0, 0.0, 1.0]), roll) @ _rotation(axis, tilt)
    focal = PHOTO[0] / 2 / math.tan(math.radians(settings["view"]) / 2)
    lens = np.array([[focal, 0, PHOTO[0] / 2], [0, focal, PHOTO[1] / 2], [0, 0, 1]])
    corners = np.array([(0, 0), (width, 0), (width, height), (0, height)], dtype=float)
    near, far = 0.2 * width, 20.0 * width
    for _ in range(60):
        distance = math.sqrt(near * far)
        matrix = lens @ np.column_stack(
            [
                turn[:, 0],
                turn[:, 1],
                -turn @ np.array([width / 2, height / 2, 0]) + np.array([0, 0, distance]),
            ]
        )
        seen = _project(matrix, corners)
        spread = np.ptp(seen, axis=0) / PHOTO
        behind = ((np.column_stack([corners, np.ones(4)]) @ matrix.T)[:, 2] <= 0).any()
        if behind or spread.max() > settings["fill"]:
            near = distance
        else:
            far = distance
    middle = (seen.max(axis=0) + seen.min(axis=0)) / 2
    shift = np.eye(3)
    shift[:2, 2] = np.array(PHOTO) / 2 - middle
    return np.asarray(shift @ matrix)


def _rotation(axis: FloatArray, angle: float) -> FloatArray:
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.asarray(np.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross)


def _project(matrix: FloatArray, points: FloatArray) -> FloatArray:
    seen = np.column_stack([points, np.ones(len(points))]) @ matrix.T
    return np.asarray(seen[:, :2] / seen[:, 2:])


def _photograph(
    sheet: Image.Image, to_photo: FloatArray, settings: dict[str, float], random: np.random.Generator
) -> Image.Image:
    """The sheet on a desk, in the light of the settings, in colour, as JPEG."""
    back = np.linalg.inv(to_photo)
    coefficients = (back / back[2, 2]).ravel()[:8].tolist()
    paper = np.asarray(
        sheet.transform(PHOTO, Image.Transform.PERSPECTIVE, coefficients, Image.Resampling.BICUBIC),
        dtype=float,
    )
    white = Image.new("L", sheet.size, 255)
    there = (
        np.asarray(
            white.transform(PHOTO, Image.Transform.PERSPECTIVE, coefficients, Image.Resampling.BILINEAR),
            dtype=float,
        )
        / 255
    )
    shape = (PHOTO[1], PHOTO[0])
    rows, columns = np.mgrid[0 : shape[0], 0 : shape[1]]
    stripes = np.sin(columns / random.uniform(15, 60) + 3 * np.sin(rows / random.uniform(100, 400)))
    desk = 235 * settings["desk"] * (1 + 0.06 * stripes + 0.05 * _texture(shape, 2.0, random))
    tint = np.array([1.0, random.uniform(0.75, 1.0), random.uniform(0.5, 1.0)])
    colours = (
        paper[..., None] * np.array([1.0, 0.985, 0.96]) * there[..., None]
        + (desk * (1 - there))[..., None] * tint
    )
    colours *= _light(shape, settings, random)[..., None]
    image = Image.fromarray(np.clip(colours, 0, 255).astype(np.uint8)).filter(
        ImageFilter.GaussianBlur(settings["blur"])
    )
    noisy = np.asarray(image, dtype=float) + random.normal(0, settings["noise"], (*shape, 3))
    stored = BytesIO()
    Image.fromarray(np.clip(noisy, 0, 255).astype(np.uint8)).save(
        stored, "JPEG", quality=int(random.integers(JPEG_QUALITY[0], JPEG_QUALITY[1] + 1))
    )
    return Image.open(BytesIO(stored.getvalue())).convert("RGB")


def _light(shape: tuple[int, int], settings: dict[str, float], random: np.random.Generator) -> FloatArray:
    """(rows, columns) at most 1: a gradient, and a shadow with a soft edge."""
    rows, columns = np.mgrid[0 : shape[0], 0 : shape[1]]
    about = random.uniform(0, math.tau)
    along = (columns / shape[1] - 0.5) * math.cos(about) + (rows / shape[0] - 0.5) * math.sin(about)
    light = random.uniform(0.85, 1.0) * (1 - random.uniform(*GRADIENT) * (along + 0.71) / 1.42)
    across = random.uniform(0, math.tau)
    edge = (columns - shape[1] * random.uniform(0.2, 0.8)) * math.cos(across) + (
        rows - shape[0] * random.uniform(0.2, 0.8)
    ) * math.sin(across)
    soft = 1 / (1 + np.exp(-4 * edge / random.uniform(*PENUMBRA)))
    return np.asarray(light * (1 - settings["shadow"] * soft))
