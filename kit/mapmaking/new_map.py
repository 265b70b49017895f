"""A map of one's own: sketched square by square, then written as world, picture, card and robot."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final

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
from kit.workspace import draft_folder, errors_name_file
from kit.world.catalogue import CARD_FILE, WORLD_FILE, maps_folder
from kit.world.connected_parts import connected_parts
from kit.world.loading import load_world

PICTURE_FILE: Final = "map.png"
MAP_FILE: Final = "map.yaml"
OVERLAY_FILE: Final = "overlay.png"
ROBOT_FILE: Final = "serp.model.yaml"

NEAR_POINT: Final = 12
"""This point of a way is near its start, and far enough to tell its direction."""
FINEST: Final = 0.01
"""Finest resolution of a map's picture [m per pixel]."""

MAX_CELLS: Final = 1_000_000
"""Most cells of floor searched for a path: enough for 60 m by 60 m."""
COARSEST: Final = 0.9 * ROBOT_RADIUS / 2
"""Side of a cell [m] on which a way is looked for while a map is drawn."""
MOST_COARSE_CELLS: Final = 100_000
NAME: Final = re.compile(r"[A-Za-z][A-Za-z0-9_-]*")

WORLD_TEXT: Final = """\
# {title}

properties: {{}}

layers:
  - name: [solid, seen]   # the same walls twice: what robots touch, and what their lasers look at
    map: map.yaml

models:
"""

MODEL_TEXT: Final = """\
  - name: {name}
    model: serp.model.yaml
{namespace}    pose: [{x:.3f}, {y:.3f}, {theta:.4f}]   # x, y [m], heading [rad]
"""
NAMESPACE_TEXT: Final = """\
    namespace: {name}   # its topics are /{name}/cmd_vel, /{name}/odom, ...
"""

OWN_HULL: Final = (
    "      - type: polygon                # the hull\n",
    "layers: [solid]",
    "layers: [solid, seen]",
)
"""Where the kit's robot has its hull, and the layers of it that change: robots on one's own map see each other. The laser stands
inside its own hull, which it therefore does not see."""
PAIR: Final = ("left", "right")
PAIR_GAP: Final = 0.4
"""Between the origins of two robots that start side by side [m]."""
PAIR_SEARCH: Final = 0.8
"""How far from the start room for them is looked for [m]."""
PAIR_TARGET_RADIUS: Final = 0.4
"""Within which two robots are in the target at the same time [m]."""

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
robot: {robot}
{partner}cases:
  - name: {name}
    start: [{x:.3f}, {y:.3f}, {theta:.4f}]
    target: [{tx:.3f}, {ty:.3f}]
{partner_start}"""


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
    partner: Pose | None = None
    """Where the second of two robots starts."""


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
    folder: Path,
    plan: WallPlan,
    *,
    title: str,
    source: str,
    overlay: Image.Image | None = None,
    is_pair: bool = False,
) -> NewMap:
    """Writes the map's files into a new folder, all or none. ``overlay``: the drawing, as large as the plan, with its
    walls tinted, over which the way is shown. ``is_pair``: whether two robots start side by side. Raises NoRoute, OSError, and ValueError if there are no walls."""
    folder.parent.mkdir(parents=True, exist_ok=True)
    with errors_name_file(folder), draft_folder(folder.parent) as made:
        _write_walls(made, plan)
        start, target, route, grid = _choose_places(made, plan, title, middle_of_floor(plan))
        partner = None
        if is_pair:
            start, partner = _side_by_side(start, grid)
        _write_world(made, title, start, partner)
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
            robot="serp" if partner is None else PAIR[0],
            partner="" if partner is None else f"partner: {PAIR[1]}\n",
            partner_start=""
            if partner is None
            else f"    partner_start: [{partner.x:.3f}, {partner.y:.3f}, {partner.theta:.4f}]\n"
            f"    target_radius: {PAIR_TARGET_RADIUS:g}\n",
        )
        (made / CARD_FILE).write_text(card)
        if overlay is not None:
            draw_overlay(overlay, plan, route, start, target).save(made / OVERLAY_FILE)
        made.rename(folder)
    return NewMap(folder, start, target, route, partner)


def find_way(plan: WallPlan) -> Route | None:
    """About the way that would prove a map of this plan, from its start to its target; those that are not set are chosen. It is
    looked for on the coarsest floor that a robot is judged on, in about a second; None: the plan is too large for that. Raises
    NoRoute, and ValueError if there are no walls."""
    width, height = plan.size
    cells = math.ceil(width * height / COARSEST**2)
    if cells > MOST_COARSE_CELLS:
        return None
    with TemporaryDirectory() as folder:
        _write_walls(Path(folder), plan)
        return _choose_places(Path(folder), plan, "", middle_of_floor(plan), cells)[2]


def _write_walls(made: Path, plan: WallPlan) -> None:
    """The files of a map but for its world and its card."""
    picture = Image.fromarray(np.where(plan.walls, 0, 255).astype(np.uint8))
    picture.save(made / PICTURE_FILE)
    (made / MAP_FILE).write_text(MAP_TEXT.format(resolution=plan.resolution))
    (made / ROBOT_FILE).write_text(own_robot_text())


def own_robot_text() -> str:
    """The kit's robot as a map of one's own has it."""
    hull, layers, wanted = OWN_HULL
    before, found, after = (maps_folder() / "robots" / ROBOT_FILE).read_text().partition(hull)
    return before + found + after.replace(layers, wanted, 1)


def _side_by_side(start: Pose, grid: OccupancyGrid) -> tuple[Pose, Pose]:
    """Where two robots start, as near the start as there is room: beside each other, else one behind the other. Raises
    NoRoute."""
    half = 0.5 * PAIR_GAP
    steps = np.arange(-PAIR_SEARCH, PAIR_SEARCH + 0.01, 0.05).tolist()
    shifts = sorted(((dx, dy) for dx in steps for dy in steps), key=lambda shift: math.hypot(*shift))
    for first, second in (((0.0, half), (0.0, -half)), ((half, 0.0), (-half, 0.0))):
        for dx, dy in shifts:
            poses = [Pose(*start.transform_point(x + dx, y + dy), start.theta) for x, y in (first, second)]
            if all(_has_room(grid, start, pose) for pose in poses):
                return poses[0], poses[1]
    raise NoRoute(
        f"There is no room for two robots at the start ({start.x:.2f}, {start.y:.2f}): side by side they need "
        f"{PAIR_GAP + 2 * ROBOT_RADIUS:.2f} m. Put S elsewhere, or give the map a larger scale."
    )


def _has_room(grid: OccupancyGrid, start: Pose, pose: Pose) -> bool:
    """Whether a robot can stand at a pose, and no wall lies between it and the start."""
    shares = np.linspace(0.0, 1.0, 20)
    line = [(start.x + share * (pose.x - start.x), start.y + share * (pose.y - start.y)) for share in shares]
    cells = [grid.cell_at(*point) for point in line]
    if not all(0 <= row < grid.shape[0] and 0 <= column < grid.shape[1] for row, column in cells):
        return False
    room = [float(grid.clearance[cell]) for cell in cells]
    return room[-1] > ROBOT_RADIUS and min(room) > 0.5 * ROBOT_RADIUS


def middle_of_floor(plan: WallPlan) -> Point:
    """A place in the largest room that walls enclose, as far from them as may be [m]; the drawing's middle where none does."""
    factor = max(1, max(plan.walls.shape) // 250)
    rows, columns = (length // factor for length in plan.walls.shape)
    blocks = plan.walls[: rows * factor, : columns * factor].reshape(rows, factor, columns, factor)
    walls = blocks.any(axis=(1, 3))
    free = connected_parts(np.pad(~walls, 1, constant_values=True))
    sizes = np.bincount(free.ravel())
    sizes[[0, free[0, 0]]] = 0
    if not sizes.any():
        used = np.argwhere(plan.walls) if plan.walls.any() else np.array([[0, 0], plan.walls.shape])
        middle = 0.5 * (used.min(axis=0) + used.max(axis=0))
        return float(middle[1]) * plan.resolution, float(plan.walls.shape[0] - middle[0]) * plan.resolution
    room = (free == int(sizes.argmax()))[1:-1, 1:-1]
    last = room
    while room.any():
        last, edge = room, np.pad(room, 1)
        room = room & edge[:-2, 1:-1] & edge[2:, 1:-1] & edge[1:-1, :-2] & edge[1:-1, 2:]
    row, column = np.argwhere(last)[0].tolist()
    height = plan.walls.shape[0]
    return (column + 0.5) * factor * plan.resolution, (height - (row + 0.5) * factor) * plan.resolution


def tint_strokes(drawing: Image.Image, walls: BoolArray, doubtful: BoolArray | None = None) -> Image.Image:
    """The drawing, as large as the plan, with walls in red and what may be none in blue."""
    height, width = walls.shape
    pixels = np.asarray(drawing.convert("RGB").resize((width, height))).copy()
    for mask, tone in ((walls, (200, 30, 30)), (doubtful, (30, 90, 220))):
        if mask is not None:
            pixels[mask] = (pixels[mask] * 0.3 + np.array(tone) * 0.7).astype(np.uint8)
    return Image.fromarray(pixels)


def draw_overlay(
    drawing: Image.Image, plan: WallPlan, route: Route, start: Pose, target: Point
) -> Image.Image:
    """The way in green over the tinted drawing, the narrowest passage in a ring, S and T."""
    height, width = plan.walls.shape
    picture = drawing.convert("RGB").resize((width, height))
    draw = ImageDraw.Draw(picture)

    def at(point: Point) -> Point:
        return point[0] / plan.resolution, height - point[1] / plan.resolution

    draw.line([at(point) for point in route.points], fill=(20, 140, 60), width=max(2, width // 300))
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


def _choose_places(
    made: Path, plan: WallPlan, title: str, middle: Point, max_cells: int = MAX_CELLS
) -> tuple[Pose, Point, Route, OccupancyGrid]:
    """Start and target, asked for or chosen, the way between them, and the floor."""
    seed = plan.start or middle
    _write_world(made, title, Pose(*seed, 0.0))
    grid: OccupancyGrid = occupancy_grid_of(load_world(made / WORLD_FILE), max_cells)
    if grid.cell_size > ROBOT_RADIUS / 2:
        raise NoRoute(
            f"A map of {plan.size[0]:.3g} m by {plan.size[1]:.3g} m is too large to prove a way in it. Give it a smaller scale."
        )
    free = grid.clearance * ~_is_wall(plan, grid)
    if plan.start is None and free[grid.cell_at(*middle)] <= ROBOT_RADIUS:  # a wall may lead through it
        place = grid.cell_center(tuple(np.unravel_index(int(free.argmax()), grid.shape)))  # type: ignore[arg-type]  # two numbers
        _write_world(made, title, Pose(*place, 0.0))
        grid = occupancy_grid_of(load_world(made / WORLD_FILE), max_cells)
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
    ahead = _straight_ahead(grid, route.points)
    return Pose(*start, math.atan2(ahead[1] - start[1], ahead[0] - start[0])), target, route, grid


def _straight_ahead(grid: OccupancyGrid, way: tuple[Point, ...]) -> Point:
    """The last point of the way to which a robot can drive straight from its first: the way itself may begin sideways, towards
    the middle of a corridor. Where there is none, a point near the start."""
    start = np.array(way[0])
    for point in reversed(way[NEAR_POINT:]):
        steps = max(2, int(math.dist(start, point) / grid.cell_size))
        line = start + np.linspace(0.0, 1.0, steps)[:, None] * (np.array(point) - start)
        if all(grid.clearance[grid.cell_at(x, y)] > ROBOT_RADIUS for x, y in line.tolist()):
            return point
    return way[min(len(way) - 1, NEAR_POINT)]


def _is_wall(plan: WallPlan, grid: OccupancyGrid) -> BoolArray:
    """(rows, columns) of the grid: whether the middle of a cell lies within the drawn wall, which may be hollow there."""
    rows, columns = plan.walls.shape
    x, y = np.floor(grid.x / plan.resolution), np.floor(grid.y / plan.resolution)
    column, row = x.astype(int).clip(0, columns - 1), (rows - 1 - y.astype(int)).clip(0, rows - 1)
    found: BoolArray = plan.walls[row[:, None], column[None, :]]
    return found


def _write_world(made: Path, title: str, start: Pose, partner: Pose | None = None) -> None:
    models = {"serp": start} if partner is None else dict(zip(PAIR, (start, partner), strict=True))
    text = WORLD_TEXT.format(title=title)
    for name, pose in models.items():
        namespace = NAMESPACE_TEXT.format(name=name) if partner is not None else ""
        text += MODEL_TEXT.format(name=name, namespace=namespace, x=pose.x, y=pose.y, theta=pose.theta)
    (made / WORLD_FILE).write_text(text)
