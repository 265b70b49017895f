"""Paints a scene through a camera into a frame; static walls are drawn once.

Sprites, single characters put over the dots: arrows, crosses, letters.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from kit.arrays import BoolArray, FloatArray
from kit.render import raster
from kit.render.camera import Camera
from kit.render.encode import Encoder, Frame, GlyphSet
from kit.render.raster import Grid
from kit.render.roles import LINE_DASHES, ROBOT_ROLES, ROLE_LOOKS, TRAIL_ROLES, Role, nearest_pen_role
from kit.render.scene import CellState, Scene, SceneBody, SceneCells, ScenePath
from kit.render.shading import FloorMap, lit_cells, sampled_cells, seen_surfaces, shade_roles

MIN_OUTLINE_ROWS = 1.5
"""A robot shorter than this many rows is drawn as an arrow; from there on with its outline too."""

WEAK_FIELD = 0.02
"""A field weaker than this share of its strongest is drawn without a direction."""

STRONG_FIELD = 0.5
"""One stronger than this is drawn with heavier arrows."""

SpriteCell = tuple[int, int]
"""Row and column."""


def size_in_rows(body: SceneBody, camera: Camera) -> float:
    """Returns the length of a body's longer side on the picture, in rows."""
    extent = body.extent
    return max(extent.width, extent.height) / camera.cell_height


class SpriteLayer:
    """Puts characters on one frame."""

    def __init__(self, frame: Frame, camera: Camera, symbols: GlyphSet) -> None:
        self._frame = frame
        self._camera = camera
        self._symbols = symbols

    def draw_scene(self, scene: Scene) -> None:
        """Draws every part of the scene, the least important first."""
        self._put_field(scene.arrows)
        for target in scene.targets:
            self._put(self._cell(target.x, target.y), self._symbols.target, Role.TARGET)
        for mark in scene.marks:
            self._put(self._cell(mark.x, mark.y), mark.label, mark.role)
        robots = scene.robots
        middles = [robot.pose.transform_point(*robot.extent.middle) for robot in robots]
        for x, y in scene.contacts.tolist():
            self._put_contact(x, y, middles)
        for number, (robot, middle) in enumerate(zip(robots, middles, strict=True)):
            self._put_robot(robot, self._cell(*middle), number, named=len(robots) > 1)

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
            self._put(self._cell(x, y), glyph, Role.FIELD, over=Role.FIELD)

    def _put_contact(self, x: float, y: float, middles: Sequence[tuple[float, float]]) -> None:
        """Draws a contact at its place, or beside it if a robot's arrow would cover it."""
        cell = self._cell(x, y)
        for middle_x, middle_y in middles:
            if cell is not None and cell == self._cell(middle_x, middle_y):
                right = (x - middle_x) / self._camera.cell_width
                down = (middle_y - y) / self._camera.cell_height
                row, column = cell
                if abs(right) >= abs(down):
                    cell = row, column + (1 if right > 0 else -1)
                else:
                    cell = row + (1 if down > 0 else -1), column
        self._put(cell, self._symbols.contact, Role.CONTACT)

    def _put_robot(self, robot: SceneBody, cell: SpriteCell | None, number: int, named: bool) -> None:
        if cell is None:
            return
        theta, extent = robot.pose.theta, robot.extent
        role, arrows = (
            ROBOT_ROLES[number % len(ROBOT_ROLES)],
            self._symbols.robot_arrows[number % len(self._symbols.robot_arrows)],
        )
        if self._symbols.heading_strokes:
            front = (
                extent.right if size_in_rows(robot, self._camera) >= MIN_OUTLINE_ROWS else extent.middle[0]
            )
            base = self._cell(*robot.pose.transform_point(front, extent.middle[1]))
            if base is not None:
                eighth = round(theta / math.tau * 8) * math.tau / 8
                ahead = base[0] - round(math.sin(eighth)), base[1] + round(math.cos(eighth))
                self._put(ahead, _arrow_glyph(self._symbols.heading_strokes, theta), role, over=Role.ROBOT)
        self._put(cell, _arrow_glyph(arrows, theta), role)
        if named:
            # Below, or above if it would cover the heading line there.
            row = cell[0] + (1 if math.sin(theta) > -0.5 else -1)
            self._put((row, cell[1]), str(number + 1), role)

    def _cell(self, x: float, y: float) -> SpriteCell | None:
        """Returns the cell of a point [m], on the picture or off; None if it is not finite."""
        column, row = self._camera.project(np.array((x, y))).tolist()
        if not (math.isfinite(column) and math.isfinite(row)):
            return None
        return math.floor(row), math.floor(column)

    def _put(self, cell: SpriteCell | None, text: str, role: Role, over: Role = Role.TEXT) -> None:
        """Puts text from the cell on, as far as it is on the picture and what is there is not more important
        than ``over``."""
        rows, columns = self._frame.shape
        if cell is None or not 0 <= cell[0] < rows:
            return
        row, first = cell
        for column, glyph in enumerate(text, first):
            if 0 <= column < columns and self._frame.fg[row, column] <= over:
                self._frame.glyphs[row, column] = ord(glyph)
                self._frame.fg[row, column] = role
                self._frame.bg[row, column] = Role.EMPTY


def _arrow_glyph(glyphs: str, angle: float) -> str:
    """The glyph that points nearest to ``angle`` [rad]."""
    return glyphs[round(angle / math.tau * len(glyphs)) % len(glyphs)]


HEADING_LINE_SHARE = 0.25
"""Length of a robot's heading line beyond its hull: this share of its length, or two characters' widths
if that is more."""

FINE_DOTS = 1.5
"""From so many dots on, walls may be half a character thick without closing a way that is open."""

MIN_HOLLOW_ROWS = 4.0
"""A robot shorter than this many rows is filled: its outline alone would be a tangle of dots."""

NO_LINES: FloatArray = np.empty((0, 4))


class Painter:
    """Draws scenes with one encoder. Keeps the walls as drawn last, and draws them again only when the
    array or the camera is another one.

    What no robot of the scene fits through is drawn solid, where dots are fine enough to tell. So the two
    faces of a thin wall make one wall, instead of now two lines and now one.

    ``shaded``: the floor, and what the lasers see of it where the scene has their beams, are backgrounds.
    """

    def __init__(self, encoder: Encoder, shaded: bool = False) -> None:
        self.encoder = encoder
        self.shaded = shaded
        self._floor_map: FloorMap | None = None
        self._floor: BoolArray = np.empty((0, 0), dtype=bool)
        self._solid: BoolArray = np.empty((0, 0), dtype=bool)
        self._walls: FloatArray | None = None
        self._view: tuple[Camera, float] | None = None
        self._wall_grid = raster.empty_grid(0, 0)

    def paint(self, scene: Scene, camera: Camera) -> Frame:
        canvas = _Canvas(self._static_grid(scene, camera).copy(), camera, self.encoder)
        floor = self._floor
        if scene.cells is not None:
            floor = canvas.draw_cells(scene.cells, marks_unknown=not self.shaded)
        if not self.shaded:
            canvas.draw_lines(scene.beams, Role.BEAM, period=3)
        for path in scene.paths:
            canvas.draw_path(path)
        for stroke in scene.strokes:
            canvas.draw_lines(raster.polyline(stroke.points), nearest_pen_role(stroke.color))
        for number, trail in enumerate(scene.trails):
            canvas.draw_points(trail, TRAIL_ROLES[number % len(TRAIL_ROLES)])
        canvas.draw_hits(scene.hits, seen_surfaces(scene.beams) if self.shaded else NO_LINES)
        for target in scene.targets:
            canvas.draw_circle(target.x, target.y, target.radius, Role.TARGET)
        for body in scene.bodies:
            if body.is_target:
                canvas.draw_outline(body, Role.TARGET)
            elif not body.is_robot:
                canvas.draw_outline(body, Role.BODY)
                canvas.fill(body, Role.BODY)
        for number, robot in enumerate(scene.robots):
            canvas.draw_robot(robot, ROBOT_ROLES[number % len(ROBOT_ROLES)])
        frame = self.encoder.encode(canvas.grid, coarse=self._is_coarse(scene, camera))
        SpriteLayer(frame, camera, self.encoder.symbols).draw_scene(scene)
        if self.shaded:
            lit = lit_cells(scene.beams, camera, frame.fg == Role.WALL_HIT)
            shades = shade_roles(floor, lit)
            shades[self._solid & (frame.fg == Role.TEXT)] = Role.FLOOR  # letters are to be read on a wall too
            np.copyto(frame.bg, shades, where=frame.bg == Role.EMPTY)
        return frame

    def _is_coarse(self, scene: Scene, camera: Camera) -> bool:
        """Whether a gap that a robot just fits through is narrower than ``FINE_DOTS``."""
        passage = _narrowest_robot(scene)
        return 0.0 < passage < FINE_DOTS * camera.cell_height / self.encoder.down

    def _static_grid(self, scene: Scene, camera: Camera) -> Grid:
        """Returns the grid of the walls, redrawn if walls or camera changed."""
        view = camera, _narrowest_robot(scene)
        if self._floor_map is None or scene.walls is not self._walls:
            self._floor_map, self._view = FloorMap(scene), None
        if view != self._view:
            across, down = self.encoder.across, self.encoder.down
            grid = _draw_walls(scene.walls, *view, self.encoder)
            grid[self._floor_map.solid_dots(camera, across, down)] = Role.WALL
            self._wall_grid, self._walls, self._view = grid, scene.walls, view
            if self.shaded:
                self._floor = self._floor_map.cells(camera, grid, across, down)
                dots = grid.reshape(camera.rows, down, camera.columns, across)
                self._solid = (dots == Role.WALL).mean(axis=(1, 3)) >= 0.5
        return self._wall_grid


def _narrowest_robot(scene: Scene) -> float:
    """The narrowest gap [m] that a robot of the scene fits through, to the millimetre; 0 without robots."""
    extents = [robot.extent for robot in scene.robots]
    widths = [min(extent.width, extent.height) for extent in extents]
    return round(min(filter(math.isfinite, widths), default=0.0), 3)


MAX_RIM = 400
"""Cells of the rim around the picture, on each side."""


def _draw_walls(walls: FloatArray, camera: Camera, passage: float, encoder: Encoder) -> Grid:
    # However large the robot, and however close the camera.
    passage = min(passage, MAX_RIM * min(camera.cell_width, camera.cell_height))
    # With a rim around the picture, for walls of which one face is just outside it.
    rim_x, rim_y = math.ceil(passage / camera.cell_width), math.ceil(passage / camera.cell_height)
    wide = camera.resized(camera.columns + 2 * rim_x, camera.rows + 2 * rim_y)
    canvas = _Canvas(
        raster.empty_grid(wide.columns * encoder.across, wide.rows * encoder.down), wide, encoder
    )
    canvas.draw_lines(walls, Role.WALL)
    # Lines n dots apart have n - 1 dots between them.
    across = int(passage / camera.cell_width * encoder.across) - 1
    down = int(passage / camera.cell_height * encoder.down) - 1
    raster.close_gaps(canvas.grid, across, down, Role.WALL)
    top, left = rim_y * encoder.down, rim_x * encoder.across
    return canvas.grid[top : top + camera.rows * encoder.down, left : left + camera.columns * encoder.across]


class _Canvas:
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

    def draw_hits(self, hits: FloatArray, surfaces: FloatArray) -> None:
        """The points where rays end, and the lines between them on one surface. Where dots are fine enough to keep both
        apart, a ray that ends on a wall lights up the wall itself."""
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
            slice(None),
            np.concatenate((cell_columns, lines[1] // across)),
        )
        dots = cells[lit]
        dots[dots == Role.WALL] = Role.WALL_HIT
        cells[lit] = dots

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
