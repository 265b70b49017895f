"""A grid of dots on which a scene's lines, outlines and cells are drawn in world coordinates."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from kit.arrays import BoolArray, FloatArray, IndexArray
from kit.render import raster
from kit.render.camera import Camera
from kit.render.encode import Encoder
from kit.render.raster import Grid
from kit.render.role_looks import LINE_DASHES, ROLE_LOOKS
from kit.render.roles import TRAIL_ROLES, Role
from kit.render.scene import CellState, Disc, SceneBody, SceneCells, ScenePath
from kit.render.shading import sampled_cells
from kit.render.sprites import MIN_OUTLINE_ROWS, size_in_rows
from kit.world.connected_parts import connected_parts

HEADING_LINE_SHARE = 0.25
"""Length of a robot's heading line beyond its hull: this share of its length, or two characters' widths
if that is more."""

MIN_HOLLOW_ROWS = 4.0
"""A robot shorter than this many rows is filled: its outline alone would be a tangle of dots."""

LEAST_RING_ROWS = 0.75
"""A target's ring with a smaller radius [rows] is left out: the symbol in its middle would fill it."""

NO_LINES: FloatArray = np.empty((0, 4))


class DotCanvas:
    """A grid of dots that takes world coordinates."""

    def __init__(self, grid: Grid, camera: Camera, encoder: Encoder) -> None:
        self.grid = grid
        self._height, self._width = grid.shape
        self._camera = camera
        self._encoder = encoder
        self._dot = camera.cell_width / encoder.across, camera.cell_height / encoder.down

    def project(self, points: FloatArray) -> FloatArray:
        return self._camera.project(points, self._encoder.across, self._encoder.down)

    def draw_points(self, points: FloatArray, role: Role) -> None:
        raster.draw_dots(self.grid, raster.point_dots(self.project(points), self._width, self._height), role)

    def draw_hits(self, hits: FloatArray, surfaces: FloatArray, faces: BoolArray) -> None:
        """The points where rays end, and the lines between them on one surface. Where dots are fine enough to keep both
        apart, a ray that ends on a wall lights up the wall itself. ``faces`` (rows, columns): characters of walls beside the
        floor, which light up instead of those behind them, into which noise carries a ray's end; empty: no walls have any."""
        if self._encoder.down < 4:
            self.draw_points(hits, Role.HIT)
            return
        height, width = self._height, self._width
        lines = raster.line_dots(self.project(surfaces.reshape(-1, 2)).reshape(-1, 4), width, height)
        rows, columns = raster.point_dots(self.project(hits), width, height)
        across, down = self._encoder.across, self._encoder.down
        cells = self.grid.reshape(height // down, down, width // across, across)
        cell_rows, cell_columns = rows // down, columns // across
        at_wall = (cells[cell_rows, :, cell_columns] == Role.WALL).any(axis=(1, 2))
        raster.draw_dots(self.grid, (rows[~at_wall], columns[~at_wall]), Role.HIT)
        lit = (
            np.concatenate((cell_rows, lines[0] // down)),
            np.concatenate((cell_columns, lines[1] // across)),
        )
        if faces.size:
            lit = _at_faces(*lit, faces)
        dots = cells[lit[0], :, lit[1]]
        dots[dots == Role.WALL] = Role.WALL_HIT
        cells[lit[0], :, lit[1]] = dots

    def draw_cells(self, cells: SceneCells, marks_unknown: bool) -> BoolArray:
        """Cells that are occupied, as walls, and where ``marks_unknown``, a pattern of dots over those of which nothing is
        known. Returns the characters (rows, columns) that are mostly free."""
        across, down = self._encoder.across, self._encoder.down
        states = sampled_cells(cells, self._camera, across, down)
        self.grid[states == CellState.OCCUPIED] = Role.WALL
        rows, columns = np.nonzero(
            cells.states == CellState.OCCUPIED
        )  # one that is smaller than a dot counts too
        middles = (np.column_stack((columns, rows)) + 0.5) * cells.cell_size + np.array(cells.origin)
        self.draw_points(middles, Role.WALL)
        if marks_unknown:
            unknown = states[down // 2 :: down, :: 2 * across] == CellState.UNKNOWN
            dots = self.grid[down // 2 :: down, :: 2 * across]
            dots[unknown & (dots == Role.EMPTY)] = Role.FIELD
        by_cell = (states == CellState.FREE).reshape(len(states) // down, down, -1, across)
        free: BoolArray = by_cell.mean(axis=(1, 3)) >= 0.5
        return free

    def draw_lines(self, segments: FloatArray, role: Role, period: int = 1, drawn: int = 1) -> None:
        """Draws lines: the first ``drawn`` of every ``period`` dots."""
        if not len(segments):
            return
        self._put_lines(self.project(segments.reshape(-1, 2)).reshape(-1, 4), role, period, drawn)

    def draw_path(self, path: ScenePath) -> None:
        role = path.role if path.robot is None else TRAIL_ROLES[path.robot % len(TRAIL_ROLES)]
        dashes = LINE_DASHES[path.style or ROLE_LOOKS[role].line]
        self.draw_lines(raster.polyline(path.points), role, *dashes)

    def draw_circle(self, x: float, y: float, radius: float, role: Role) -> None:
        """The circle's line; nothing where it would be a dot or two: a symbol marks the place."""
        if radius < max(self._dot):
            return
        column, row = self.project(np.array((x, y))).tolist()
        if not (math.isfinite(column) and math.isfinite(row)):
            return
        # About the middle of a dot, it is as round as dots can be.
        middle = math.floor(column) + 0.5, math.floor(row) + 0.5
        corners = raster.circle_corners(*middle, radius / self._dot[0], radius / self._dot[1])
        self._put_lines(raster.polyline(corners, closed=True), role)

    def draw_dots(self, dots: raster.Dots, role: Role) -> None:
        raster.draw_dots(self.grid, dots, role)

    def draw_outline(self, body: SceneBody, role: Role) -> None:
        edges = [raster.polyline(polygon, closed=True) for polygon in body.polygons]
        self.draw_lines(np.concatenate((NO_LINES, *edges)), role)
        for disc in body.discs:
            self.draw_circle(*disc, role)

    def fill(self, body: SceneBody, role: Role) -> None:
        for polygon in body.polygons:
            self._fill(self.project(polygon), role)
        for disc in body.discs:
            self._fill(self.project(raster.circle_corners(disc.x, disc.y, disc.radius, disc.radius)), role)

    def draw_robot(self, robot: SceneBody, role: Role) -> None:
        """Its outline, where that is large enough to be made out, and a line from its middle ahead."""
        size = size_in_rows(robot, self._camera)
        if size >= MIN_OUTLINE_ROWS:
            self.draw_outline(robot, role)
            if size < MIN_HOLLOW_ROWS:
                self.fill(robot, role)
        if not self._encoder.symbols.heading_strokes:
            self._put_lines(_heading_line(robot, self._camera, self._encoder), role)

    def _fill(self, corners: FloatArray, role: Role) -> None:
        raster.draw_dots(self.grid, raster.filled_dots(corners, self._width, self._height), role)

    def _put_lines(self, dots: FloatArray, role: Role, period: int = 1, drawn: int = 1) -> None:
        rows, columns = raster.line_dots(dots, self._width, self._height)
        if drawn < period:
            kept = np.arange(len(rows)) % period < drawn
            rows, columns = rows[kept], columns[kept]
        raster.draw_dots(self.grid, (rows, columns), role)


def ring_dots(target: Disc, wall_cells: BoolArray, camera: Camera, encoder: Encoder) -> raster.Dots:
    """The dots of a target's ring: the rim of the part of its disc that is in characters without a wall, so that the ring is
    closed and of dots everywhere. None where it would be smaller than the symbol in its middle, or that is in a wall.

    ``wall_cells``: (rows, columns): the characters with a wall.
    """
    nothing = np.empty(0, dtype=np.intp)
    across, down = encoder.across, encoder.down
    radius_x = target.radius / camera.cell_width * across
    radius_y = target.radius / camera.cell_height * down
    middle = camera.project(np.array((target.x, target.y)), across, down)
    if radius_y < LEAST_RING_ROWS * down or not (np.isfinite(middle).all() and math.isfinite(radius_x)):
        return nothing, nothing
    height, width = wall_cells.shape[0] * down, wall_cells.shape[1] * across
    # About the middle of a dot, it is as round as dots can be. One more dot on each side shows where it leaves the picture.
    column, row = np.floor(middle)
    left, right = np.clip((column - radius_x - 1, column + radius_x + 2), -1, width + 1).astype(np.intp)
    top, bottom = np.clip((row - radius_y - 1, row + radius_y + 2), -1, height + 1).astype(np.intp)
    if not (left <= column < right and top <= row < bottom):
        return nothing, nothing
    rows, columns = np.arange(top, bottom), np.arange(left, right)
    away_x, away_y = (columns - column) / (radius_x + 0.5), (rows - row) / (radius_y + 0.5)
    inside = away_x**2 + (away_y**2)[:, None] < 1.0
    last_row, last_column = wall_cells.shape[0] - 1, wall_cells.shape[1] - 1
    at = np.clip(rows // down, 0, last_row)[:, None], np.clip(columns // across, 0, last_column)
    inside &= ~wall_cells[at]
    parts = connected_parts(inside)
    here = parts[int(row) - top, int(column) - left]
    inside = (parts == here) & (here > 0)
    padded = np.pad(inside, 1)
    within = padded[:-2, 1:-1] & padded[2:, 1:-1] & padded[1:-1, :-2] & padded[1:-1, 2:]
    rim = inside & ~within
    rim &= ((rows >= 0) & (rows < height))[:, None] & ((columns >= 0) & (columns < width))
    rim_rows, rim_columns = np.nonzero(rim)
    return rim_rows + top, rim_columns + left


def _heading_line(robot: SceneBody, camera: Camera, encoder: Encoder) -> FloatArray:
    """A robot's heading line, (1, 4) in dots: from its middle to well before its front."""
    extent = robot.extent
    middle = extent.middle
    places = (middle, (extent.right, middle[1]), (extent.right + 1.0, middle[1]))
    start, front, ahead = camera.project(
        np.array([robot.pose.transform_point(*place) for place in places]), encoder.across, encoder.down
    )
    step = (ahead - front) / np.abs(ahead - front).max()  # one dot along the longer axis
    beyond = max(2.0, HEADING_LINE_SHARE * extent.width / camera.cell_width) * encoder.across
    return np.concatenate((start, front + step * beyond))[None]


BESIDE: Final = np.array(((-1, 0), (1, 0), (0, -1), (0, 1), (0, -2), (0, 2)))
"""Rows and columns to the characters beside one; a character is twice as high as wide."""


def _at_faces(rows: IndexArray, columns: IndexArray, faces: BoolArray) -> tuple[IndexArray, IndexArray]:
    """Characters, but for each that is no face of a wall those beside it that are, if there are any."""
    behind = np.flatnonzero(~faces[rows, columns])
    beside_rows = (rows[behind] + BESIDE[:, :1]).clip(0, len(faces) - 1)
    beside_columns = (columns[behind] + BESIDE[:, 1:]).clip(0, faces.shape[1] - 1)
    beside = faces[beside_rows, beside_columns]
    replaced = behind[beside.any(axis=0)]
    return (
        np.concatenate((np.delete(rows, replaced), beside_rows[beside])),
        np.concatenate((np.delete(columns, replaced), beside_columns[beside])),
    )
