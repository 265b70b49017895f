"""Paints a scene through a camera into a frame; static walls are drawn once."""

from __future__ import annotations

import math

import numpy as np

from kit.arrays import BoolArray, FloatArray
from kit.render import raster
from kit.render.camera import Camera
from kit.render.dot_canvas import DotCanvas, ring_dots
from kit.render.encode import Encoder, Frame
from kit.render.raster import Grid
from kit.render.role_looks import nearest_pen_role
from kit.render.roles import ROBOT_ROLES, TRAIL_ROLES, Role
from kit.render.scene import Disc, Scene
from kit.render.shading import FloorMap, facing, lit_cells, seen_surfaces, shade_roles
from kit.render.sprites import SpriteLayer, size_in_rows

FINE_DOTS = 1.5
"""From this many dots on, walls may be half a character thick without closing a way that is open."""

NO_FACES: BoolArray = np.empty((0, 0), dtype=bool)

LEAST_TARGET_ROWS = 3.0
"""The outline of what stands on a target is left out where it has fewer rows: the symbol there would be a tangle with it."""


class Painter:
    """Draws scenes with one encoder. Keeps the walls as drawn last, and draws them again only when the
    array or the camera is another one.

    What no robot of the scene fits through is drawn solid, where dots are fine enough to tell. So the two
    faces of a thin wall make one wall, instead of now two lines and now one.

    ``shaded``: the floor, and what the lasers see of it where the scene shows their beams, are backgrounds.
    """

    def __init__(self, encoder: Encoder, shaded: bool = False) -> None:
        self.encoder = encoder
        self.shaded = shaded
        self._floor_map: FloorMap | None = None
        self._floor: BoolArray = np.empty((0, 0), dtype=bool)
        self._solid: BoolArray = np.empty((0, 0), dtype=bool)
        self._faces = NO_FACES
        """Characters of walls beside the floor."""
        self._lasers: FloatArray = np.empty((0, 2))
        self._faced = NO_FACES
        """The characters in which lasers are, and the faces that they can see."""
        self._walls: FloatArray | None = None
        self._view: tuple[Camera, float] | None = None
        self._wall_grid = raster.empty_grid(0, 0)
        self._wall_cells: BoolArray = np.empty((0, 0), dtype=bool)
        self._rings: dict[Disc, raster.Dots] = {}
        """The rings of targets on these walls."""

    def paint(self, scene: Scene, camera: Camera) -> Frame:
        canvas = DotCanvas(self._static_grid(scene, camera).copy(), camera, self.encoder)
        floor = self._floor
        if scene.cells is not None:
            floor = canvas.draw_cells(scene.cells, marks_unknown=not self.shaded)
        if scene.shows_beams and not self.shaded:
            canvas.draw_lines(scene.beams, Role.BEAM, period=3)
        for path in scene.paths:
            canvas.draw_path(path)
        for stroke in scene.strokes:
            canvas.draw_lines(raster.polyline(stroke.points), nearest_pen_role(stroke.color))
        for number, trail in enumerate(scene.trails):
            canvas.draw_points(trail, TRAIL_ROLES[number % len(TRAIL_ROLES)])
        canvas.draw_hits(scene.hits, seen_surfaces(scene.beams), self._seen_faces(scene, camera))
        for target in scene.targets:
            canvas.draw_dots(self._ring(target, camera), Role.TARGET)
        for body in scene.bodies:
            if body.is_target:
                if not scene.targets or size_in_rows(body, camera) >= LEAST_TARGET_ROWS:
                    canvas.draw_outline(body, Role.TARGET)
            elif not body.is_robot:
                canvas.draw_outline(body, Role.BODY)
                canvas.fill(body, Role.BODY)
        for number, robot in enumerate(scene.robots):
            canvas.draw_robot(robot, ROBOT_ROLES[number % len(ROBOT_ROLES)])
        frame = self.encoder.encode(canvas.grid, coarse=self._is_coarse(scene, camera))
        sprites = SpriteLayer(frame, camera, self.encoder.symbols, scene.walls, self._wall_cells, self.shaded)
        sprites.draw_scene(scene)
        if self.shaded:
            rays = scene.beams if scene.shows_beams else scene.beams[:0]
            lit = lit_cells(rays, camera, frame.fg == Role.WALL_HIT)
            shades = shade_roles(floor, lit)
            shades[self._solid & (frame.fg == Role.TEXT)] = Role.FLOOR  # letters are to be read on a wall too
            np.copyto(frame.bg, shades, where=frame.bg == Role.EMPTY)
        return frame

    def _seen_faces(self, scene: Scene, camera: Camera) -> BoolArray:
        """The faces of walls that a laser of the scene can see; computed anew when one is in another character."""
        if scene.cells is not None:
            return NO_FACES
        if not self._faces.size or not len(scene.beams):
            return self._faces
        first = np.append(True, (scene.beams[1:, :2] != scene.beams[:-1, :2]).any(axis=1))
        lasers = np.floor(camera.project(scene.beams[first, :2]))
        if not np.array_equal(lasers, self._lasers):
            self._lasers, self._faced = lasers, self._faces & facing(self._wall_cells, lasers)
        return self._faced

    def _ring(self, target: Disc, camera: Camera) -> raster.Dots:
        if target not in self._rings:
            self._rings[target] = ring_dots(target, self._wall_cells, camera, self.encoder)
        return self._rings[target]

    def _is_coarse(self, scene: Scene, camera: Camera) -> bool:
        """Whether a gap that a robot just fits through is narrower than ``FINE_DOTS``."""
        widest = FINE_DOTS * camera.cell_height / self.encoder.down
        return bool(scene.robots) and 0.0 < scene.narrowest_way < widest

    def _static_grid(self, scene: Scene, camera: Camera) -> Grid:
        """Returns the grid of the walls, redrawn if walls or camera changed."""
        view = camera, scene.narrowest_way
        if self._floor_map is None or scene.walls is not self._walls:
            self._floor_map, self._view = FloorMap(scene), None
        if view != self._view:
            across, down = self.encoder.across, self.encoder.down
            grid = _draw_walls(scene.walls, *view, self.encoder)
            np.copyto(grid, np.uint8(Role.WALL), where=self._floor_map.solid_dots(camera, across, down))
            self._wall_grid, self._walls, self._view = grid, scene.walls, view
            self._rings.clear()
            self._wall_cells = raster.drawn_cells(grid, across, down)
            self._floor = self._floor_map.cells(camera, grid, across, down)
            walled = grid.reshape(camera.rows, down, camera.columns, across) == Role.WALL
            self._solid = walled.mean(axis=(1, 3)) >= 0.5
            self._lasers = np.empty((0, 2))
            self._faces = self._wall_cells & _beside(self._floor & ~self._wall_cells)
        return self._wall_grid


MAX_RIM = 400
"""Cells of the rim around the picture, on each side."""


def _draw_walls(walls: FloatArray, camera: Camera, passage: float, encoder: Encoder) -> Grid:
    # However large the robot, and however close the camera.
    passage = min(passage, MAX_RIM * min(camera.cell_width, camera.cell_height))
    # With a rim around the picture, for walls of which one face is just outside it.
    rim_x, rim_y = math.ceil(passage / camera.cell_width), math.ceil(passage / camera.cell_height)
    wide = camera.resized(camera.columns + 2 * rim_x, camera.rows + 2 * rim_y)
    canvas = DotCanvas(
        raster.empty_grid(wide.columns * encoder.across, wide.rows * encoder.down), wide, encoder
    )
    canvas.draw_lines(walls, Role.WALL)
    # Lines n dots apart have n - 1 dots between them.
    across = int(passage / camera.cell_width * encoder.across) - 1
    down = int(passage / camera.cell_height * encoder.down) - 1
    raster.close_gaps(canvas.grid, across, down, Role.WALL)
    top, left = rim_y * encoder.down, rim_x * encoder.across
    return canvas.grid[top : top + camera.rows * encoder.down, left : left + camera.columns * encoder.across]


def _beside(cells: BoolArray) -> BoolArray:
    """The cells and those around them, corners too."""
    padded = np.pad(cells, 1)
    rows, columns = cells.shape
    found: BoolArray = np.logical_or.reduce(
        [padded[row : row + rows, column : column + columns] for row in range(3) for column in range(3)]
    )
    return found
