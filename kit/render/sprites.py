"""Sprites: what is drawn into a frame as one character where dots would be too coarse."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from kit.arrays import BoolArray, FloatArray
from kit.render.camera import Camera
from kit.render.encode import Frame, GlyphSet
from kit.render.roles import ROBOT_ROLES, Role
from kit.render.scene import Scene, SceneBody
from kit.segments import nearest_on_segments

MIN_OUTLINE_ROWS = 1.5
"""A robot shorter than this many rows is drawn as an arrow; from there on with its outline too."""

WEAK_FIELD = 0.02
"""A field weaker than this share of its strongest is drawn without a direction."""

STRONG_FIELD = 0.5
"""One stronger than this is drawn with heavier arrows."""

ROBOT_BLOCKS = "█▙▛▜▟"
"""Blocks of a solid robot that become the background of a character on them: else it would look like a hole."""

SpriteCell = tuple[int, int]
"""Row and column."""


def size_in_rows(body: SceneBody, camera: Camera) -> float:
    """Returns the length of a body's longer side on the picture, in rows."""
    extent = body.extent
    return max(extent.width, extent.height) / camera.cell_height


class SpriteLayer:
    """Puts characters on one frame."""

    def __init__(
        self,
        frame: Frame,
        camera: Camera,
        symbols: GlyphSet,
        walls: FloatArray,
        wall_cells: BoolArray,
        shaded: bool = False,
    ) -> None:
        """``walls``: ``x1 y1 x2 y2`` [m]. ``wall_cells``: the cells in which there is some. ``shaded``: the floor has a colour,
        in which characters on a solid robot are written."""
        self._shaded = shaded
        self._frame = frame
        self._camera = camera
        self._symbols = symbols
        self._walls = walls
        self._wall_cells = wall_cells

    def draw_scene(self, scene: Scene) -> None:
        """Draws every part of the scene, the least important first."""
        self._put_field(scene.arrows)
        for target in scene.targets:
            self._put_text(self._cell_at(target.x, target.y), self._symbols.target, Role.TARGET)
        for mark in scene.marks:
            self._put_text(self._cell_at(mark.x, mark.y), mark.label, mark.role)
        robots = scene.robots
        middles = [robot.pose.transform_point(*robot.extent.middle) for robot in robots]
        for x, y in scene.contacts.tolist():
            self._put_contact(x, y, middles)
        for number, (robot, middle) in enumerate(zip(robots, middles, strict=True)):
            self._put_robot(robot, middle, number, named=len(robots) > 1)

    def _put_field(self, arrows: FloatArray) -> None:
        """Arrows where nothing else is."""
        strongest = arrows[:, 4].max(initial=0.0)
        for x, y, dx, dy, strength in arrows.tolist():
            glyph = self._symbols.weak_field_dot
            if strength > WEAK_FIELD * strongest:
                glyphs = (
                    self._symbols.strong_field_arrows
                    if strength > STRONG_FIELD
                    else self._symbols.field_arrows
                )
                glyph = _arrow_glyph(glyphs, math.atan2(dy, dx))
            self._put_text(self._cell_at(x, y), glyph, Role.FIELD, over=Role.FIELD)

    def _put_contact(self, x: float, y: float, middles: Sequence[tuple[float, float]]) -> None:
        """Draws a contact at its place, or beside it if a robot's arrow would cover it."""
        cell = self._cell_at(x, y)
        for middle_x, middle_y in middles:
            if cell is not None and cell == self._robot_cell(middle_x, middle_y):
                right = (x - middle_x) / self._camera.cell_width
                down = (middle_y - y) / self._camera.cell_height
                row, column = cell
                if abs(right) >= abs(down):
                    cell = row, column + (1 if right > 0 else -1)
                else:
                    cell = row + (1 if down > 0 else -1), column
        self._put_text(cell, self._symbols.contact, Role.CONTACT)

    def _put_robot(self, robot: SceneBody, middle: tuple[float, float], number: int, named: bool) -> None:
        at, cell = self._cell_at(*middle), self._robot_cell(*middle)
        if at is None or cell is None:
            return
        if at != cell:
            self._frame.fg[at] = Role.WALL
        theta, extent = robot.pose.theta, robot.extent
        role, arrows = (
            ROBOT_ROLES[number % len(ROBOT_ROLES)],
            self._symbols.robot_arrows[number % len(self._symbols.robot_arrows)],
        )
        if self._symbols.heading_strokes:
            front = (
                extent.right if size_in_rows(robot, self._camera) >= MIN_OUTLINE_ROWS else extent.middle[0]
            )
            base = self._cell_at(*robot.pose.transform_point(front, extent.middle[1]))
            if base is not None:
                eighth = round(theta / math.tau * 8) * math.tau / 8
                row, column = base[0] + cell[0] - at[0], base[1] + cell[1] - at[1]
                ahead = row - round(math.sin(eighth)), column + round(math.cos(eighth))
                self._put_text(
                    ahead, _arrow_glyph(self._symbols.heading_strokes, theta), role, over=Role.ROBOT
                )
        self._put_text(cell, _arrow_glyph(arrows, theta), role)
        if named:
            # Below, or above if it would cover the heading line there.
            row = cell[0] + (1 if math.sin(theta) > -0.5 else -1)
            self._put_text((row, cell[1]), str(number + 1), role)

    def _robot_cell(self, x: float, y: float) -> SpriteCell | None:
        """The cell of a robot's arrow: beside a wall that it stands at, not in it, where a cell holds both."""
        cell = self._cell_at(x, y)
        if cell is None or not self._is_wall(cell):
            return cell
        # The wall is in this cell: of thousands only those near it are measured.
        reach = 2.0 * math.hypot(self._camera.cell_width, self._camera.cell_height)
        x1, y1, x2, y2 = self._walls.T
        is_near = (np.abs(0.5 * (x1 + x2) - x) <= 0.5 * np.abs(x2 - x1) + reach) & (
            np.abs(0.5 * (y1 + y2) - y) <= 0.5 * np.abs(y2 - y1) + reach
        )
        near = self._walls[is_near] if is_near.any() else self._walls
        distances, nearest = nearest_on_segments(np.array(((x, y),)), near)
        wall_x, wall_y = nearest[0, distances[0].argmin()].tolist()
        right, down = (x - wall_x) / self._camera.cell_width, (wall_y - y) / self._camera.cell_height
        row, column = cell
        ways = (
            (abs(right), (row, column + (1 if right > 0 else -1))),
            (abs(down), (row + (1 if down > 0 else -1), column)),
        )
        return next((each for _, each in sorted(ways, reverse=True) if self._is_floor(each)), cell)

    def _is_wall(self, cell: SpriteCell) -> bool:
        return self._is_shown(cell) and bool(self._wall_cells[cell])

    def _is_floor(self, cell: SpriteCell) -> bool:
        return self._is_shown(cell) and not self._wall_cells[cell]

    def _is_shown(self, cell: SpriteCell) -> bool:
        rows, columns = self._frame.shape
        return 0 <= cell[0] < rows and 0 <= cell[1] < columns

    def _cell_at(self, x: float, y: float) -> SpriteCell | None:
        """Returns the cell of a point [m], on the picture or off; None if it is not finite."""
        column, row = self._camera.project(np.array((x, y))).tolist()
        if not (math.isfinite(column) and math.isfinite(row)):
            return None
        return math.floor(row), math.floor(column)

    def _put_text(self, cell: SpriteCell | None, text: str, role: Role, over: Role = Role.TEXT) -> None:
        """Puts text from the cell on, as far as it is on the picture and what is there is not more important
        than ``over``."""
        rows, columns = self._frame.shape
        if cell is None or not 0 <= cell[0] < rows:
            return
        row, first = cell
        for column, glyph in enumerate(text, first):
            if 0 <= column < columns and self._frame.fg[row, column] <= over:
                below = Role(self._frame.fg[row, column])
                is_on_robot = (
                    self._shaded
                    and below in ROBOT_ROLES
                    and chr(self._frame.glyphs[row, column]) in ROBOT_BLOCKS
                )
                self._frame.glyphs[row, column] = ord(glyph)
                self._frame.fg[row, column] = Role.FLOOR if is_on_robot else role
                self._frame.bg[row, column] = below if is_on_robot else Role.EMPTY


def _arrow_glyph(glyphs: str, angle: float) -> str:
    """The glyph that points nearest to ``angle`` [rad]."""
    return glyphs[round(angle / math.tau * len(glyphs)) % len(glyphs)]
