"""A map of one's own: sketched square by square, then written as world, picture, card and robot."""

from __future__ import annotations

import math
import re
import shutil
import tempfile
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final, Literal, Self

import numpy as np
from PIL import Image, ImageDraw

from kit.arrays import BoolArray
from kit.fields.occupancy_grid import OccupancyGrid, occupancy_grid_of
from kit.geometry import Pose
from kit.mapmaking.route import (
    NEAREST_TARGET,
    ROBOT_RADIUS,
    NoRoute,
    Point,
    Route,
    check_closed,
    farthest_apart,
    widest_route,
)
from kit.plain_text import quoted
from kit.workspace import errors_name_file
from kit.world.catalogue import CARD_FILE, WORLD_FILE, maps_folder
from kit.world.loading import load_world

PICTURE_FILE: Final = "map.png"
MAP_FILE: Final = "map.yaml"
OVERLAY_FILE: Final = "overlay.png"
ROBOT_FILE: Final = "serp.model.yaml"
FINEST: Final = 0.01
"""Finest resolution of a map's picture [m per pixel]."""
MAX_CELLS: Final = 1_000_000
"""Most cells of floor searched for a path: enough for 60 m by 60 m."""
NAME: Final = re.compile(r"[A-Za-z][A-Za-z0-9_-]*")

WORLD_TEXT: Final = """\
# {title}

properties: {{}}

layers:
  - name: [solid, seen]   # the same walls twice: what robots touch, and what their lasers look at
    map: map.yaml

models:
  - name: serp
    model: serp.model.yaml
    pose: [{x:.3f}, {y:.3f}, {theta:.4f}]   # x, y [m], heading [rad]
"""
MAP_TEXT: Final = """\
# Walls from a picture: they run where dark pixels meet bright ones.
image: map.png
resolution: {resolution:.6g}       # metres per pixel
origin: [0, 0, 0]          # pose of the picture's lower left corner: x, y [m], heading
occupied_thresh: 0.65      # pixels darker than 65 % of white are wall
"""
CARD_TEXT: Final = """\
title: {title}
summary: {summary}
source: {source}
robot: serp
cases:
  - name: {name}
    start: [{x:.3f}, {y:.3f}, {theta:.4f}]
    target: [{tx:.3f}, {ty:.3f}]
"""


class MapExists(ValueError):
    """A folder of that name is there, or the name cannot be one; the message says what to do."""


@dataclass(frozen=True, slots=True, eq=False)
class WallPlan:
    """Walls as pixels, with a scale."""

    walls: BoolArray
    """(rows, columns), the top row first."""
    resolution: float
    """[m per pixel]"""
    start: Point | None = None
    """[m] from the lower left corner; None: chosen by the kit."""
    target: Point | None = None

    @property
    def size(self) -> tuple[float, float]:
        """Width and height [m]."""
        return self.walls.shape[1] * self.resolution, self.walls.shape[0] * self.resolution


@dataclass(frozen=True, slots=True)
class NewMap:
    """A map that was written, with the way that proves it."""

    folder: Path
    start: Pose
    target: Point
    route: Route


def check_name(name: str, folder: Path) -> Path:
    """The folder of a new map of that name. Raises MapExists."""
    if not NAME.fullmatch(name):
        raise MapExists(
            f"{quoted(name)} cannot be a map's name: use letters, digits, - and _, starting with a letter."
        )
    if (folder / name).exists():
        raise MapExists(f"{folder / name} already exists. Choose another name, or remove that folder.")
    return folder / name


def write_map(
    folder: Path, plan: WallPlan, *, title: str, source: str, overlay: Image.Image | None = None
) -> NewMap:
    """Writes the map's files into a new folder, all or none. ``overlay``: the drawing, as large as the plan, over which
    walls and way are shown. Raises NoRoute, OSError, and ValueError if there are no walls."""
    folder.parent.mkdir(parents=True, exist_ok=True)
    with (
        errors_name_file(folder),
        tempfile.TemporaryDirectory(dir=folder.parent, prefix=f".{folder.name}.") as name,
    ):
        made = Path(name) / folder.name
        made.mkdir()
        picture = Image.fromarray(np.where(plan.walls, 0, 255).astype(np.uint8))
        picture.save(made / PICTURE_FILE)
        (made / MAP_FILE).write_text(MAP_TEXT.format(resolution=plan.resolution))
        robots = maps_folder() / "robots"
        shutil.copyfile(robots / ROBOT_FILE, made / ROBOT_FILE)
        middle = (plan.size[0] / 2, plan.size[1] / 2)
        start, target, route = _place(made, plan, title, middle)
        _write_world(made, title, start)
        card = CARD_TEXT.format(
            title=quoted(title),
            summary=quoted(
                f"{plan.size[0]:.3g} m by {plan.size[1]:.3g} m; its narrowest passage is {route.width:.2f} m wide"
            ),
            source=quoted(source),
            name=folder.name,
            x=start.x,
            y=start.y,
            theta=start.theta,
            tx=target[0],
            ty=target[1],
        )
        (made / CARD_FILE).write_text(card)
        if overlay is not None:
            draw_overlay(overlay, plan, route, start, target).save(made / OVERLAY_FILE)
        made.rename(folder)
    return NewMap(folder, start, target, route)


def draw_overlay(
    drawing: Image.Image, plan: WallPlan, route: Route, start: Pose, target: Point
) -> Image.Image:
    """The walls in red over the drawing, the way in blue, the narrowest passage in a ring, S and T."""
    height, width = plan.walls.shape
    picture = drawing.convert("RGB").resize((width, height))
    pixels = np.asarray(picture).copy()
    pixels[plan.walls] = (pixels[plan.walls] * 0.3 + np.array([200, 30, 30]) * 0.7).astype(np.uint8)
    picture = Image.fromarray(pixels)
    draw = ImageDraw.Draw(picture)

    def at(point: Point) -> Point:
        return point[0] / plan.resolution, height - point[1] / plan.resolution

    draw.line([at(point) for point in route.points], fill=(30, 80, 220), width=max(2, width // 300))
    radius = max(6.0, route.width / 2 / plan.resolution)
    x, y = at(route.narrowest)
    draw.ellipse(
        (x - radius, y - radius, x + radius, y + radius), outline=(230, 140, 0), width=max(2, width // 250)
    )
    for letter, place in (("S", (start.x, start.y)), ("T", target)):
        x, y = at(place)
        draw.ellipse((x - 12, y - 12, x + 12, y + 12), fill=(20, 120, 60))
        draw.text((x, y), letter, fill=(255, 255, 255), anchor="mm")
    return picture


def _place(made: Path, plan: WallPlan, title: str, middle: Point) -> tuple[Pose, Point, Route]:
    """Start and target, asked for or chosen, and the way between them."""
    seed = plan.start or middle
    _write_world(made, title, Pose(*seed, 0.0))
    grid: OccupancyGrid = occupancy_grid_of(load_world(made / WORLD_FILE), MAX_CELLS)
    if grid.cell_size > ROBOT_RADIUS / 2:
        raise NoRoute(
            f"A map of {plan.size[0]:.3g} m by {plan.size[1]:.3g} m is too large to prove a way in it. Give it a smaller scale."
        )
    free = grid.clearance * ~_is_wall(plan, grid)
    if plan.start is None and free[grid.cell_at(*middle)] <= ROBOT_RADIUS:  # a wall may lead through it
        place = grid.cell_center(tuple(np.unravel_index(int(free.argmax()), grid.shape)))  # type: ignore[arg-type]  # two numbers
        _write_world(made, title, Pose(*place, 0.0))
        grid = occupancy_grid_of(load_world(made / WORLD_FILE), MAX_CELLS)
    if plan.start and plan.target:
        start, target = plan.start, plan.target
    elif plan.target:
        target, start = farthest_apart(grid, plan.target)
    else:
        start, target = farthest_apart(grid, plan.start)
    apart = math.dist(start, target)
    if apart < NEAREST_TARGET and not (plan.start and plan.target):
        given = "start" if plan.start else "target" if plan.target else ""
        raise NoRoute(
            f"No {'place for start and target' if not given else f'second place for the {given}'} was found: from "
            f"({start[0]:.2f}, {start[1]:.2f}) a robot that needs {2 * ROBOT_RADIUS:.2f} m gets only {apart:.2f} m far. The "
            "lines were read as walls all around it: give the map a larger scale, thinner or fewer lines, or name both "
            "start and target."
        )
    route = widest_route(grid, start, target)
    check_closed(grid, start)
    ahead = route.points[min(len(route.points) - 1, 12)]
    return Pose(*start, math.atan2(ahead[1] - start[1], ahead[0] - start[0])), target, route


def _is_wall(plan: WallPlan, grid: OccupancyGrid) -> BoolArray:
    """(rows, columns) of the grid: whether the middle of a cell lies within the drawn wall, which may be hollow there."""
    rows, columns = plan.walls.shape
    x, y = np.floor(grid.x / plan.resolution), np.floor(grid.y / plan.resolution)
    column, row = x.astype(int).clip(0, columns - 1), (rows - 1 - y.astype(int)).clip(0, rows - 1)
    found: BoolArray = plan.walls[row[:, None], column[None, :]]
    return found


def _write_world(made: Path, title: str, start: Pose) -> None:
    (made / WORLD_FILE).write_text(WORLD_TEXT.format(title=title, x=start.x, y=start.y, theta=start.theta))


WALL: Final = "#"
FLOOR: Final = " ."
MAX_SIDE: Final = 400
"""Characters of a row, and rows."""
CELL: Final = 0.5
"""Side of a character's square [m], unless another is asked for."""


class DrawingError(ValueError):
    """A drawing that is no map; the message names line and column."""


def read_drawing(text: str, *, cell: float = CELL, name: str = "the drawing") -> WallPlan:
    """The walls of a drawing; each character is a square of ``cell`` metres. Raises DrawingError.

    >>> plan = read_drawing("#####\\n#S T#\\n#####", cell=0.5)
    >>> plan.size, plan.start, plan.target
    ((2.5, 1.5), (0.75, 0.75), (1.75, 0.75))
    """
    rows = [line.rstrip("\n\r") for line in text.expandtabs(4).splitlines()]
    while rows and not rows[-1].strip():
        rows.pop()
    while rows and not rows[0].strip():
        rows.pop(0)
    if not rows:
        raise DrawingError(f"{name} is empty. Draw walls with #, the start with S and the target with T.")
    columns = max(map(len, rows))
    if max(len(rows), columns) > MAX_SIDE:
        raise DrawingError(
            f"{name} has {len(rows)} rows of up to {columns} characters; at most {MAX_SIDE} are read."
        )
    marks: dict[str, tuple[int, int]] = {}
    walls = np.zeros((len(rows), columns), dtype=np.bool_)
    for number, row in enumerate(rows):
        for column, letter in enumerate(row):
            place = f"{name}, line {number + 1}, column {column + 1}"
            if letter == WALL:
                walls[number, column] = True
            elif letter in "ST":
                if letter in marks:
                    raise DrawingError(f"{place}: a second {letter}; a map has one start and one target.")
                marks[letter] = (number, column)
            elif letter not in FLOOR:
                raise DrawingError(
                    f"{place}: {quoted(letter)} is not one of # (wall), space (floor), S (start) and T (target)."
                )
    if not walls.any():
        raise DrawingError(f"{name} has no wall. Draw walls with #.")
    fine = max(1, min(8, int(cell / FINEST), 2000 // max(len(rows), columns)))
    points = {
        letter: ((column + 0.5) * cell, (len(rows) - number - 0.5) * cell)
        for letter, (number, column) in marks.items()
    }
    return WallPlan(
        np.kron(walls, np.ones((fine, fine), dtype=np.bool_)), cell / fine, points.get("S"), points.get("T")
    )


Square = tuple[int, int]
"""Column and row, from the upper left corner."""
SketchMark = Literal["#", " ", "S", "T"]
"""Wall, floor, start, target, as in a drawing in characters."""

MIN_SIDE: Final = 4
SCALES: Final = (0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5, 0.6, 0.75, 1.0, 1.5, 2.0, 3.0, 5.0)
"""Sides of a square to choose from [m]."""


@dataclass(frozen=True, slots=True)
class MapSketch:
    """Rows of ``#``, blanks, at most one S and one T, as ``read_drawing`` reads them."""

    rows: tuple[str, ...]
    """All equally long."""
    cell: float = CELL
    """Side of a square [m]."""

    @classmethod
    def room(cls, columns: int, rows: int, cell: float = CELL) -> Self:
        """An empty room with walls around it. ValueError for a size that is too small or too large.

        >>> print(MapSketch.room(5, 4).text)
        #####
        #   #
        #   #
        #####
        <BLANKLINE>
        """
        if not (MIN_SIDE <= columns <= MAX_SIDE and MIN_SIDE <= rows <= MAX_SIDE):
            raise ValueError(f"{columns} x {rows} squares; each side takes {MIN_SIDE} to {MAX_SIDE}")
        inner = "#" + " " * (columns - 2) + "#"
        return cls(("#" * columns, *([inner] * (rows - 2)), "#" * columns), cell)

    @property
    def columns(self) -> int:
        return len(self.rows[0])

    @property
    def text(self) -> str:
        """The drawing in characters."""
        return "\n".join(self.rows) + "\n"

    @property
    def size(self) -> tuple[float, float]:
        """Width and height [m]."""
        return self.columns * self.cell, len(self.rows) * self.cell

    def find(self, mark: SketchMark) -> Square | None:
        """Returns the square of the start or the target; None if it has not been set."""
        return next(((row.index(mark), number) for number, row in enumerate(self.rows) if mark in row), None)

    def is_inside(self, square: Square) -> bool:
        return 0 <= square[0] < self.columns and 0 <= square[1] < len(self.rows)

    def drawn(self, mark: SketchMark, square: Square) -> Self:
        """Returns the sketch with a mark in a square; it moves a start or target. Outside the sheet nothing changes."""
        if not self.is_inside(square):
            return self
        rows = list(self.rows)
        if mark in "ST":
            rows = [row.replace(mark, " ") for row in rows]
        column, number = square
        rows[number] = rows[number][:column] + mark + rows[number][column + 1 :]
        return replace(self, rows=tuple(rows))

    def drawn_line(self, mark: SketchMark, first: Square, last: Square) -> Self:
        """Returns the sketch with a mark in every square from one square to another (Bresenham 1965)."""
        sketch = self
        for square in squares_between(first, last):
            sketch = sketch.drawn(mark, square)
        return sketch

    def scaled(self, steps: int) -> Self:
        """Returns the sketch with squares this many places further in ``SCALES``."""
        nearest = min(range(len(SCALES)), key=lambda place: abs(SCALES[place] - self.cell))
        return replace(self, cell=SCALES[max(0, min(nearest + steps, len(SCALES) - 1))])


def squares_between(first: Square, last: Square) -> list[Square]:
    """The squares on the straight line between two, both included."""
    (x, y), (x2, y2) = first, last
    dx, dy = abs(x2 - x), -abs(y2 - y)
    step_x, step_y = (1 if x2 > x else -1), (1 if y2 > y else -1)
    error, squares = dx + dy, [first]
    while (x, y) != last:
        twice = 2 * error
        if twice >= dy:
            error += dy
            x += step_x
        if twice <= dx:
            error += dx
            y += step_y
        squares.append((x, y))
    return squares
