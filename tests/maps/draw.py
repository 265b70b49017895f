"""Draws every picture and every line file of ``maps/``: ``python tests/maps/draw.py [NAME ...]``.

A plan says where a robot may be, in metres of the map's own world; the walls follow, as a rim around that
free space. Resolution and origin are read from the map's layer file, so that they are written down once.
The same plan always gives the same picture: the only dice are Python's ``random.Random(seed).random``.
"""

from __future__ import annotations

import math
import random
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import yaml
from numpy.typing import NDArray
from PIL import Image

MAPS = Path(__file__).resolve().parents[2] / "maps"

Grid = NDArray[np.floating[Any]]
Point = tuple[float, float]
Shape = Callable[[Grid, Grid], Grid]
"""How far the points (x, y) [m] lie outside a shape; negative inside."""


# The vocabulary.


def nothing(x: Grid, y: Grid) -> Grid:
    return np.full(np.broadcast(x, y).shape, np.inf)


def box(x0: float, y0: float, x1: float, y1: float) -> Shape:
    """The rectangle with these two corners. Grown by a wall it keeps its square corners."""
    cx, cy, hx, hy = (x0 + x1) / 2, (y0 + y1) / 2, (x1 - x0) / 2, (y1 - y0) / 2
    return lambda x, y: np.maximum(np.abs(x - cx) - hx, np.abs(y - cy) - hy)


def disc(cx: float, cy: float, radius: float) -> Shape:
    return lambda x, y: np.hypot(x - cx, y - cy) - radius


def ring(cx: float, cy: float, inner: float, outer: float) -> Shape:
    middle, half = (inner + outer) / 2, (outer - inner) / 2
    return lambda x, y: np.abs(np.hypot(x - cx, y - cy) - middle) - half


def band(points: Sequence[Point], width: float) -> Shape:
    """All points within half a ``width`` of a polyline."""

    def distance(x: Grid, y: Grid) -> Grid:
        nearest = nothing(x, y)
        for (ax, ay), (bx, by) in pairwise(points):
            dx, dy = bx - ax, by - ay
            along = np.clip(((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy), 0, 1)
            nearest = np.minimum(nearest, np.hypot(x - ax - along * dx, y - ay - along * dy))
        return nearest - width / 2

    return distance


def join(*shapes: Shape) -> Shape:
    def distance(x: Grid, y: Grid) -> Grid:
        nearest = nothing(x, y)
        for shape in shapes:
            nearest = np.minimum(nearest, shape(x, y))
        return nearest

    return distance


def boxes(*corners: tuple[float, float, float, float]) -> Shape:
    return join(*(box(*four) for four in corners))


def floor_plan(name: str, corner: Point, cell: float, wall: float) -> Shape:
    """The blanks of the text ``NAME.txt`` beside this file, typed with ``+ - |``, each cell two characters wide.

    ``corner`` is the lower left corner of the lower left cell, ``cell`` its side, ``wall`` what lies between.
    """
    rows = Path(__file__).with_name(f"{name}.txt").read_text(encoding="utf-8").splitlines()

    def span(start: float, cells_before: int, in_wall: bool) -> Point:
        low = start + cells_before * (cell + wall)
        return (low - wall, low) if in_wall else (low, low + cell)

    blanks = []
    for j, row in enumerate(reversed(rows)):
        for i, mark in enumerate(row):
            if mark == " ":
                (x0, x1), (y0, y1) = span(corner[0], i // 3, i % 3 == 0), span(corner[1], j // 2, j % 2 == 0)
                blanks.append(box(x0, y0, x1, y1))
    return join(*blanks)


def points(text: str) -> list[Point]:
    """``x,y`` pairs [m] with blanks between."""
    pairs = (pair.split(",") for pair in text.split())
    return [(float(x), float(y)) for x, y in pairs]


def arc(cx: float, cy: float, radius: float, start: float, end: float) -> list[Point]:
    """Points on a circle from the angle ``start`` to ``end`` [degrees], both included, 7.5 degrees apart."""
    pieces = round(abs(end - start) / 7.5)
    angles = (math.radians(start + (end - start) * i / pieces) for i in range(pieces + 1))
    return [(cx + radius * math.cos(angle), cy + radius * math.sin(angle)) for angle in angles]


def smooth_loop(corners: Sequence[Point], pieces: int = 8) -> list[Point]:
    """A closed Catmull-Rom spline through ``corners``, as a polyline."""
    n, out = len(corners), []
    for i in range(n):
        a, b, c, d = (np.array(corners[(i + k) % n]) for k in (-1, 0, 1, 2))
        for t in (k / pieces for k in range(pieces)):
            x, y = b + t / 2 * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)))
            out.append((float(x), float(y)))
    return [*out, out[0]]


def beside(loop: Sequence[Point], distance: float) -> list[Point]:
    """A closed polyline at a distance to the left of another one."""
    corners, out = loop[:-1], []
    for i, (x, y) in enumerate(corners):
        (ax, ay), (bx, by) = corners[i - 1], corners[(i + 1) % len(corners)]
        length = math.hypot(bx - ax, by - ay)
        out.append((x - distance * (by - ay) / length, y + distance * (bx - ax) / length))
    return [*out, out[0]]


def spiral(centre: Point, radius: float, pitch: float, turns: float) -> list[Point]:
    """Inwards and clockwise from ``radius``, as a polyline; ``pitch`` [m] lies between one turn and the next."""
    angles = [-math.radians(15 * i) for i in range(round(turns * 24) + 1)]
    at = [(radius + pitch * angle / math.tau, angle) for angle in angles]
    return [(centre[0] + r * math.cos(angle), centre[1] + r * math.sin(angle)) for r, angle in at]


@dataclass(frozen=True)
class Plan:
    """A picture to draw: where a robot may be, the walls around that, and the things that stand in it."""

    size: Point
    """Of the whole picture [m]."""
    free: Shape
    wall: float = 0.1
    """Thickness [m]; infinite fills the picture."""
    things: Shape = nothing

    def picture(self, resolution: float, origin: Sequence[float]) -> Image.Image:
        """8-bit grey, walls black; ``origin`` is where the picture's lower left corner lies."""
        columns, rows = (round(length / resolution) for length in self.size)
        x = origin[0] + resolution * (np.arange(columns) + 0.5)[None, :]
        y = origin[1] + resolution * (rows - np.arange(rows) - 0.5)[:, None]
        outside = self.free(x, y)
        dark = np.where(outside > 0, outside < self.wall, self.things(x, y) < 0)
        return Image.fromarray(np.where(dark, 0, 255).astype(np.uint8))


def lines(*chains: Sequence[Point]) -> str:
    """The segments of these polylines as a Flatland .dat file: ``x1 y1 x2 y2`` [m] on each line."""
    pairs = (pair for chain in chains for pair in pairwise(chain))
    return "".join(f"{ax:.4f} {ay:.4f} {bx:.4f} {by:.4f}\n" for (ax, ay), (bx, by) in pairs)


# The dissertation's maps, to its dimensions.


def house() -> Plan:
    rooms = boxes(
        (-4.0, -3.2, 0.6, 0.6),  # living room, in which (0, 0) lies
        (0.7, -3.2, 3.6, -0.7),  # kitchen
        (0.7, -0.6, 3.6, 0.6),  # hall
        (-4.0, 0.7, -1.1, 2.7),  # bedroom
        (-1.0, 0.7, 1.5, 2.7),  # bathroom
        (1.6, 0.7, 3.6, 2.7),  # study
    )
    doors = boxes(
        (0.5, -0.4, 0.8, 0.4),  # living room to hall
        (0.5, -2.6, 0.8, -1.8),  # living room to kitchen
        (2.6, -0.8, 3.4, -0.5),  # kitchen to hall
        (-2.4, 0.5, -1.6, 0.8),  # living room to bedroom
        (0.75, 0.5, 1.4, 0.8),  # hall to bathroom
        (2.2, 0.5, 3.0, 0.8),  # hall to study
    )
    furniture = boxes(
        (-4.0, -2.6, -3.3, -0.6),  # sofa
        (-2.8, -2.0, -2.2, -1.2),  # low table
        (0.7, -3.2, 3.6, -2.75),  # kitchen counter
        (3.1, -2.75, 3.6, -1.5),  # and its other leg
        (-4.0, 1.2, -2.8, 2.7),  # bed
        (-1.6, 2.2, -1.1, 2.7),  # wardrobe
        (-1.0, 1.95, 0.4, 2.7),  # bath
        (1.1, 2.2, 1.5, 2.7),  # basin
        (2.0, 2.2, 3.4, 2.7),  # desk
    )
    dining_table = disc(-0.95, -2.1, 0.45)
    return Plan((8.0, 6.19), join(rooms, doors), things=join(furniture, dining_table))


def simple() -> Plan:
    blocks = boxes((-3.2, -1.5, -2.0, -0.9), (-0.9, 1.2, 0.5, 1.4), (1.2, -0.7, 1.4, 1.7))
    hook = boxes((2.2, -1.7, 3.1, -1.5), (2.2, -1.5, 2.4, -0.8))
    return Plan((8.25, 5.175), box(-4.4, -2.5, 3.65, 2.475), things=join(blocks, hook, disc(-2.5, 1.2, 0.4)))


TRACK = smooth_loop(
    points(
        "0,0.6 0,-0.6 0.7,-1.4 2,-1.5 3.1,-1 4.2,-0.5 5.3,-1 6.6,-1.5 7.9,-1.2 8.3,0 7.9,1.3 6.9,2.2 "
        "5.8,1.9 5.1,1 4.1,0.7 3.2,1.2 2.3,2.2 1,2.3 0.2,1.6"
    )
)

LEG = (0.1, 0.1, 1.15, 2.9)
"""The straight corridor, and the left leg of every other hallway."""


def hall(*things: tuple[float, float, float, float]) -> Plan:
    return Plan((1.25, 3.0), box(*LEG), things=boxes(*things))


SEED_PICTURES = {
    "maze": Plan((8.25, 5.175), floor_plan("maze", corner=(-0.625, -4.1), cell=0.625, wall=0.1)),
    "simple": simple(),
    "racetrack": Plan((9.23, 4.875), band(TRACK, 0.7), wall=math.inf),
    "house": house(),
    "turn": Plan((2.4, 2.4), boxes((-0.42, -0.22, 0.42, 2.02), (-0.42, 1.22, 1.82, 2.02)), wall=0.08),
    "hall_straight": hall(),
    "hall_left_door": hall((0.45, 1.4, 1.15, 1.5)),
    "hall_center_door": hall((0.1, 1.4, 0.45, 1.5), (0.8, 1.4, 1.15, 1.5)),
    "hall_right_door": hall((0.1, 1.4, 0.8, 1.5)),
    "hall_two_doors": hall((0.1, 1.4, 0.2, 1.5), (0.55, 1.4, 0.7, 1.5), (1.05, 1.4, 1.15, 1.5)),
    "hall_small_obstacle": hall((0.55, 1.3, 0.7, 1.6)),
    "hall_large_obstacle": hall((0.45, 1.3, 0.8, 1.6)),
    "hall_turn_90": Plan((3.0, 3.0), boxes(LEG, (0.1, 1.9, 2.9, 2.9))),
    "hall_turn_180": Plan((2.4, 3.0), boxes(LEG, (1.25, 0.1, 2.3, 2.9), (0.1, 1.9, 2.3, 2.9))),
}

# The curves are lines: straight legs where they belong, and round walls that are round, not stairs of pixels.

SEED_LINES = {
    "hall_curve_90": lines(
        points("0.1,1.5 0.1,0.1 1.15,0.1 1.15,1.5"),
        arc(1.6, 1.5, 0.45, 180, 90),
        points("1.6,1.95 1.6,1.9 2.9,1.9 2.9,2.9 1.5,2.9"),
        arc(1.5, 1.5, 1.4, 90, 180),
    ),
    "hall_curve_180": lines(
        points("0.1,1.5 0.1,0.1 1.15,0.1 1.15,1.5 1.05,1.5"),
        arc(1.5, 1.5, 0.45, 180, 0),
        points("1.95,1.5 1.85,1.5 1.85,0.1 2.9,0.1 2.9,1.5"),
        arc(1.5, 1.5, 1.4, 0, 180),
    ),
}

# Our own.


def forest(seed: int, trees: int) -> Plan:
    """Tree trunks at random, 0.45 m or more apart, none near the two corners where a robot starts or arrives."""
    rng = random.Random(seed)
    placed = [(0.6, 0.6, 0.2), (6.4, 3.9, 0.2)]
    while len(placed) < trees + 2:
        x, y, radius = 0.1 + 6.8 * rng.random(), 0.1 + 4.3 * rng.random(), 0.08 + 0.14 * rng.random()
        if all(math.hypot(x - u, y - v) > radius + r + 0.45 for u, v, r in placed):
            placed.append((x, y, radius))
    return Plan((7.0, 4.5), box(0.1, 0.1, 6.9, 4.4), things=join(*(disc(*tree) for tree in placed[2:])))


def office() -> Plan:
    corridor = box(0.1, 1.8, 7.1, 2.7)
    rooms = boxes((0.1, 0.1, 3.4, 1.7), (3.5, 0.1, 7.1, 1.7), (0.1, 2.8, 2.6, 4.4), (2.7, 2.8, 7.1, 4.4))
    doors = boxes((1.0, 1.6, 1.6, 1.9), (5.6, 1.6, 6.2, 1.9), (1.6, 2.6, 2.2, 2.9), (4.4, 2.6, 5.0, 2.9))
    desks = boxes((2.3, 0.3, 2.9, 1.2), (4.2, 0.1, 5.0, 0.6), (6.5, 0.6, 7.1, 1.3), (0.1, 3.6, 0.9, 4.4))
    tables = boxes((3.3, 3.3, 4.3, 3.9), (5.7, 3.3, 6.3, 4.0))
    return Plan((7.2, 4.5), join(corridor, rooms, doors), things=join(desks, tables))


def parking() -> Plan:
    in_bays = boxes(*((x, 0.15, x + 0.4, 0.85) for x in (0.2, 0.75, 1.3, 1.85, 2.9, 3.45, 4.0)))
    at_the_kerb = boxes(*((x, 2.4, x + 0.8, 2.8) for x in (0.2, 1.2, 3.1, 4.05)))
    return Plan((5.0, 3.0), box(0.1, 0.1, 4.9, 2.9), things=join(in_bays, at_the_kerb))


def warehouse() -> Plan:
    shelves = boxes(*((x, y, x + 2.4, y + 0.3) for x in (1.2, 4.4) for y in (0.75, 1.65, 2.55, 3.45)))
    ramps = boxes((1.2, 4.35, 3.6, 4.9), (5.6, 4.35, 6.8, 4.9))
    return Plan((8.0, 5.0), box(0.1, 0.1, 7.9, 4.9), things=join(shelves, ramps))


OWN_PICTURES = {
    "gate": Plan((4.0, 2.4), box(0.1, 0.1, 3.9, 2.3), things=boxes((1.9, 0, 2.1, 1.3), (1.9, 1.7, 2.1, 2.4))),
    "slalom": Plan(
        (6.0, 2.4),
        box(0.1, 0.1, 5.9, 2.3),
        things=boxes((1.2, 0, 1.3, 1.45), (2.2, 0.95, 2.3, 2.4), (3.2, 0, 3.3, 1.45), (4.2, 0.95, 4.3, 2.4)),
    ),
    "parking": parking(),
    "roundabout": Plan(
        (4.8, 4.8),
        join(
            ring(2.4, 2.4, 0.6, 1.4),
            boxes((0.1, 2.0, 1.4, 2.8), (3.4, 2.0, 4.7, 2.8), (2.0, 0.1, 2.8, 1.4), (2.0, 3.4, 2.8, 4.7)),
        ),
        wall=math.inf,
    ),
    "figure_eight": Plan(
        (6.4, 3.6), join(ring(1.9, 1.8, 0.95, 1.65), ring(4.5, 1.8, 0.95, 1.65)), wall=math.inf
    ),
    "office": office(),
    "warehouse": warehouse(),
    "forest": forest(seed=7, trees=30),
    "spiral": Plan((4.8, 4.8), band(spiral((2.4, 2.4), 2.0, 0.62, 2.9), 0.52), wall=math.inf),
    "depot": Plan(
        (7.2, 4.5),
        boxes((0.1, 0.1, 7.1, 3.1), *((x, 3.0, x + 0.9, 4.4) for x in (0.8, 2.4, 4.0, 5.6))),
        things=box(1.9, 1.3, 4.7, 1.7),
    ),
    "crossing": Plan(
        (6.0, 4.0),
        boxes((0.1, 1.5, 5.9, 2.5), *((x - 0.35, 0.1, x + 0.35, 3.9) for x in (1.6, 3.0, 4.4))),
    ),
    "labyrinth": Plan(
        (8.25, 5.2), floor_plan("labyrinth", corner=(0.075, 0.075), cell=0.45, wall=0.05), wall=0.05
    ),
}

RACE = smooth_loop(
    points("0,0 3,0 6,-0.4 9,0 10.6,2 9.8,4.2 7.4,4.4 6,3 4.2,2.6 3,3.8 1.4,5 -1.4,4.6 -2.6,2.4 -2,0.6")
)


def around(radius: float, turned: float = 0.0) -> list[Point]:
    """The corners of a hexagon about (0, 0), the first one again at the end; ``turned`` [degrees]."""
    angles = (math.radians(60 * i + turned) for i in range(7))
    return [(radius * math.cos(angle), radius * math.sin(angle)) for angle in angles]


OWN_LINES = {
    "turtlebot": lines(around(2.6), *(arc(*middle, 0.15, 0, 360) for middle in around(1.3, 30)[:6])),
    "f1tenth": lines(beside(RACE, 0.9), beside(RACE, -0.9)),
    "canyon": lines(
        points(
            "0,0.9 0.9,0.6 1.7,1.3 2.6,0.9 3.1,0.1 4.2,0.4 4.7,1.5 5.5,1.7 6.3,1.1 7.2,1.4 8,1.1 8.2,2.6 "
            "7.3,2.9 6.4,2.3 5.6,3 4.5,2.7 3.8,1.6 3.2,2 2.7,2.5 1.6,2.4 0.8,2 0.1,2.2 0,0.9"
        ),
        points("3.3,1 3.6,0.8 3.9,1 3.6,1.2 3.3,1"),
        points("5.5,2.25 5.9,2.1 5.8,2.45 5.5,2.25"),
    ),
}

PLANS = SEED_PICTURES | OWN_PICTURES
LINE_FILES = SEED_LINES | OWN_LINES


def picture(name: str) -> Image.Image:
    """The picture of one map, at the resolution and origin that its layer file says."""
    layer = yaml.safe_load((MAPS / name / "map.yaml").read_text(encoding="utf-8"))
    return PLANS[name].picture(layer["resolution"], layer["origin"])


def main(names: Sequence[str]) -> None:
    for name in names or [*PLANS, *LINE_FILES]:
        if name in PLANS:
            picture(name).save(MAPS / name / "map.png", optimize=True)
        else:
            (MAPS / name / "map.dat").write_text(LINE_FILES[name], encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
