"""A scene at one instant: plain frozen data in world coordinates, metres and radians."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass, field
from enum import IntEnum
from functools import cache, cached_property, partial
from typing import NamedTuple

import numpy as np

from kit.arrays import FloatArray, Uint8Array
from kit.geometry import Pose
from kit.render.role_looks import LineStyle
from kit.render.roles import Role


@cache
def _no_rows(width: int) -> FloatArray:
    """No rows; always the same array, since the walls' identity matters."""
    nothing = np.empty((0, width))
    nothing.setflags(write=False)
    return nothing


class SceneBounds(NamedTuple):
    """An upright rectangle [m]."""

    left: float
    bottom: float
    right: float
    top: float

    @property
    def width(self) -> float:
        return self.right - self.left

    @property
    def height(self) -> float:
        return self.top - self.bottom

    @property
    def middle(self) -> tuple[float, float]:
        return (self.left + self.right) / 2, (self.bottom + self.top) / 2


class Disc(NamedTuple):
    """A circle [m]: the shape of a body, or a target and how near counts as reached."""

    x: float
    y: float
    radius: float


class SceneMark(NamedTuple):
    """A place with a short name, such as a start."""

    x: float
    y: float
    label: str
    role: Role = Role.TEXT
    """Whose colour the name has."""


@dataclass(frozen=True, eq=False)
class SceneBody:
    """One body as it lies in the world."""

    model: str
    pose: Pose
    polygons: tuple[FloatArray, ...] = ()
    """Each (k, 2): the corners of one convex footprint; the last joins the first."""
    discs: tuple[Disc, ...] = ()
    is_robot: bool = False
    """A robot is drawn with its heading and in its own colour; other bodies are filled."""
    is_target: bool = False
    """It stands where the target is, and is drawn as a part of it."""

    @cached_property
    def extent(self) -> SceneBounds:
        """Its bounding rectangle in its own frame, x forward and y left."""
        rounds = np.array(self.discs, dtype=float).reshape(-1, 3)
        points = np.concatenate((*self.polygons, rounds[:, :2], np.array([self.pose[:2]])))
        cos, sin = np.cos(self.pose.theta), np.sin(self.pose.theta)
        local = (points - self.pose[:2]) @ np.array(((cos, -sin), (sin, cos)))
        radii = np.zeros((len(local), 1))
        radii[len(local) - 1 - len(rounds) : -1, 0] = rounds[:, 2]
        (left, bottom), (right, top) = (local - radii).min(axis=0), (local + radii).max(axis=0)
        return SceneBounds(float(left), float(bottom), float(right), float(top))


@dataclass(frozen=True, slots=True, eq=False)
class ScenePath:
    """A line to draw: a plan, a ghost's way, a segment charge."""

    points: FloatArray
    """(k, 2)"""
    style: LineStyle | None = None
    """None: as ways of its role are drawn."""
    role: Role = Role.PATH
    robot: int | None = None
    """The robot whose way it is, from 0: drawn in the colour of that robot or its trail; None: in that of its role."""


class PenStroke(NamedTuple):
    """A line that was drawn on the ground, with its colour in red, green and blue, 0 to 255."""

    points: FloatArray
    """(k, 2)"""
    color: tuple[int, int, int]


class CellState(IntEnum):
    """What is known of a cell."""

    UNKNOWN = 0
    FREE = 1
    OCCUPIED = 2
    OUTSIDE = 3
    """Not on the grid."""


@dataclass(frozen=True, slots=True, eq=False)
class SceneCells:
    """A grid of square cells of which something is known, such as an occupancy grid."""

    states: Uint8Array
    """(rows, columns) of ``CellState``; row 0 is at the bottom."""
    origin: tuple[float, float]
    """The lower left corner [m]."""
    cell_size: float
    """Side of a cell [m]."""

    @property
    def bounds(self) -> SceneBounds:
        rows, columns = self.states.shape
        left, bottom = self.origin
        return SceneBounds(left, bottom, left + columns * self.cell_size, bottom + rows * self.cell_size)

    def state_at(self, x: float, y: float) -> CellState:
        """What is known of the cell of a point [m].

        >>> cells = SceneCells(np.array([[1, 2]], dtype=np.uint8), (0.0, 0.0), 0.5)
        >>> cells.state_at(0.7, 0.1).name, cells.state_at(0.7, 0.6).name
        ('OCCUPIED', 'OUTSIDE')
        """
        column = math.floor((x - self.origin[0]) / self.cell_size)
        line = math.floor((y - self.origin[1]) / self.cell_size)
        rows, columns = self.states.shape
        if not (0 <= column < columns and 0 <= line < rows):
            return CellState.OUTSIDE
        return CellState(int(self.states[line, column]))


@dataclass(frozen=True, slots=True, eq=False)
class Scene:
    """Everything that can be drawn. Robots are numbered in the order of ``bodies``, from 1."""

    walls: FloatArray = field(default_factory=partial(_no_rows, 4))
    """(n, 4) ``x1 y1 x2 y2``. Hand over the same array again and it is not drawn again: its identity is the
    key of the static layer."""
    bodies: tuple[SceneBody, ...] = ()
    hits: FloatArray = field(default_factory=partial(_no_rows, 2))
    """(m, 2): where laser rays ended. Rows that are not finite are left out."""
    beams: FloatArray = field(default_factory=partial(_no_rows, 4))
    """(m, 4): the rays themselves, from the laser to the hit."""
    shows_beams: bool = True
    """Whether the rays are drawn, not only what they see of the walls."""
    targets: tuple[Disc, ...] = ()
    trails: tuple[FloatArray, ...] = ()
    """One (k, 2) per robot, drawn as single dots: see ``kit.render.scene.Trail``."""
    contacts: FloatArray = field(default_factory=partial(_no_rows, 2))
    """(c, 2): where bodies touch."""
    marks: tuple[SceneMark, ...] = ()
    arrows: FloatArray = field(default_factory=partial(_no_rows, 5))
    """(a, 5) ``x y dx dy strength``: a field; the direction need not be of unit length, strength is 0 to 1."""
    paths: tuple[ScenePath, ...] = ()
    strokes: tuple[PenStroke, ...] = ()
    cells: SceneCells | None = None
    """What takes the place of the floor, where it is known by cells."""
    passage: float = 0.0
    """Width [m] of the narrowest way, where no robot is drawn that tells it: what is narrower belongs to a wall."""

    @property
    def robots(self) -> tuple[SceneBody, ...]:
        return tuple(body for body in self.bodies if body.is_robot)

    @property
    def narrowest_way(self) -> float:
        """The narrowest gap [m] that a robot of the scene fits through, to the millimetre; without robots ``passage``."""
        widths = [min(robot.extent.width, robot.extent.height) for robot in self.robots]
        return round(min(filter(math.isfinite, widths), default=self.passage), 3)

    @property
    def bounds(self) -> SceneBounds:
        """The walls' extent; where there are none, that of the cells, or of everything else."""
        if self.cells is not None and not len(self.walls):
            return self.cells.bounds
        points = [self.walls.reshape(-1, 2)]
        if not len(self.walls):
            points += [np.array([body.pose[:2]]) for body in self.bodies]
            points += [polygon for body in self.bodies for polygon in body.polygons]
            for x, y, radius in (*self.targets, *(disc for body in self.bodies for disc in body.discs)):
                points.append(np.array([(x - radius, y - radius), (x + radius, y + radius)]))
            points += [path.points for path in self.paths]
            points += [self.arrows[:, :2]]
        every = np.concatenate(points)
        every = every[np.isfinite(every).all(axis=1)]
        if not len(every):
            return SceneBounds(-1.0, -1.0, 1.0, 1.0)
        (left, bottom), (right, top) = every.min(axis=0), every.max(axis=0)
        return SceneBounds(float(left), float(bottom), float(right), float(top))


@dataclass
class Trail:
    """Points along a robot's way. Each keeps its place as long as it lasts, so the trail never shimmers."""

    spacing: float = 0.12
    """Distance [m] between points."""
    length: int = 160
    """Points kept. The older half is thinned to every other point, the older quarter to every fourth."""

    _points: deque[tuple[int, float, float]] = field(default_factory=deque, init=False, repr=False)
    _serial: int = field(default=0, init=False, repr=False)

    def add(self, x: float, y: float) -> None:
        """Notes where the robot is now. Costs nothing while it stays within the spacing."""
        if self._points:
            _, last_x, last_y = self._points[-1]
            if math.hypot(x - last_x, y - last_y) < self.spacing:
                return
        self._points.append((self._serial, x, y))
        self._serial += 1
        while self._points[0][0] <= self._serial - 1 - self.length:
            self._points.popleft()

    def clear(self) -> None:
        self._points.clear()

    @property
    def points(self) -> FloatArray:
        """(k, 2) [m], oldest first."""
        kept = [(x, y) for serial, x, y in self._points if serial % self._stride(serial) == 0]
        return np.array(kept, dtype=float).reshape(-1, 2)

    def _stride(self, serial: int) -> int:
        age = (self._serial - 1 - serial) / self.length
        return 1 if age < 0.5 else 2 if age < 0.75 else 4
