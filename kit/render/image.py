"""Scene and camera to pixels: for ``rgb_array`` rendering, pictures and animations."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import BinaryIO

import numpy as np
from PIL import Image, ImageDraw

from kit.arrays import FloatArray, Uint8Array
from kit.render.camera import Camera
from kit.render.palettes import COLOR_SCHEMES
from kit.render.raster import circle_corners, polyline
from kit.render.roles import ROBOT_ROLES, TRAIL_ROLES, Role
from kit.render.scene import Scene, SceneBody, SceneBounds, ScenePath

Pixels = Uint8Array
"""(height, width, 3), red-green-blue."""

Color = tuple[int, int, int]

BACKGROUND: Color = (250, 249, 246)

IMAGE_THEMES: Mapping[str, Mapping[Role, Color]] = MappingProxyType(
    {
        "light": {**COLOR_SCHEMES["light"].roles, Role.EMPTY: BACKGROUND},
        "dark": {**COLOR_SCHEMES["dark"].roles, Role.EMPTY: COLOR_SCHEMES["dark"].background},
    }
)
"""On white paper and on black; each role differs from its neighbours in lightness too, so that print and colour-blind
eyes tell it apart."""

SUPERSAMPLING = 2
"""Pixels are averaged over squares with sides of this many."""


def image_camera(bounds: SceneBounds, width: int, height: int) -> Camera:
    """The camera that shows all of ``bounds`` in a picture of this many pixels, with a small margin."""
    return Camera.fit(bounds, width, height, aspect=1.0, margin=min(width, height) / 40)


def draw_image(scene: Scene, camera: Camera, colors: Mapping[Role, Color] = IMAGE_THEMES["light"]) -> Pixels:
    """The scene, by default on white paper; ``camera.columns`` x ``camera.rows`` pixels."""
    canvas = _ImageCanvas(camera, colors)
    if scene.shows_beams:
        canvas.lines(scene.beams, Role.LIT_NEAR)
    for path in scene.paths:
        canvas.lines(polyline(path.points), path_role(path))
    for number, trail in enumerate(scene.trails):
        canvas.points(trail, TRAIL_ROLES[number % len(TRAIL_ROLES)], 1.5)
    for target in scene.targets:
        canvas.circle(*target, Role.TARGET)
        canvas.points(np.array([target[:2]]), Role.TARGET, 2.0)
    canvas.lines(scene.walls, Role.WALL, width=1.5)
    for body in scene.bodies:
        if not body.is_robot:
            canvas.body(body, Role.TARGET if body.is_target else Role.BODY, filled=not body.is_target)
    canvas.points(scene.hits, Role.HIT, 1.5)
    canvas.arrows(scene.arrows)
    robots = scene.robots
    for number, robot in enumerate(robots):
        canvas.robot(
            robot, ROBOT_ROLES[number % len(ROBOT_ROLES)], str(number + 1) if len(robots) > 1 else ""
        )
    for x, y in scene.contacts:
        canvas.cross(x, y)
    for mark in scene.marks:
        canvas.text(mark.x, mark.y, mark.label, mark.role)
    return canvas.pixels()


def path_role(path: ScenePath) -> Role:
    """What a path is drawn as on paper: as the robot whose way it is."""
    return path.role if path.robot is None else ROBOT_ROLES[path.robot % len(ROBOT_ROLES)]


def save_image(path: Path, pixels: Pixels) -> None:
    """Writes one picture; the name's ending says in which format."""
    Image.fromarray(pixels).save(path)


def save_animation(file: Path | BinaryIO, frames: Iterable[Pixels], fps: float = 20.0) -> None:
    """Writes an endless GIF into a file, by its path or open. ValueError without a frame. A GIF keeps time in steps of 10 ms."""
    pictures = (Image.fromarray(pixels).quantize(64) for pixels in frames)
    first = next(pictures, None)
    if first is None:
        raise ValueError("no frames")
    first.save(
        file,
        format="GIF",
        save_all=True,
        append_images=pictures,
        duration=round(1000 / fps),
        loop=0,
    )


class _ImageCanvas:
    """Draws world coordinates on paper, at a finer grain than the picture will have."""

    def __init__(self, camera: Camera, colors: Mapping[Role, Color]) -> None:
        self._camera = camera
        self._colors = colors
        size = camera.columns * SUPERSAMPLING, camera.rows * SUPERSAMPLING
        self._image = Image.new("RGB", size, colors[Role.EMPTY])
        self._draw = ImageDraw.Draw(self._image)

    def pixels(self) -> Pixels:
        return np.array(self._image.reduce(SUPERSAMPLING))

    def lines(self, segments: FloatArray, role: Role, width: float = 1.0) -> None:
        finite = segments[np.isfinite(segments).all(axis=1)]
        for x1, y1, x2, y2 in self._project(finite.reshape(-1, 2)).reshape(-1, 4).tolist():
            self._draw.line((x1, y1, x2, y2), self._colors[role], round(width * SUPERSAMPLING))

    def points(self, points: FloatArray, role: Role, radius: float) -> None:
        for x, y in self._project(points[np.isfinite(points).all(axis=1)]).tolist():
            size = radius * SUPERSAMPLING
            self._draw.ellipse((x - size, y - size, x + size, y + size), self._colors[role])

    def circle(self, x: float, y: float, radius: float, role: Role, filled: bool = False) -> None:
        self._shape(circle_corners(x, y, radius, radius), self._colors[role], filled)

    def body(self, body: SceneBody, role: Role, filled: bool = False) -> None:
        for polygon in body.polygons:
            self._shape(polygon, self._colors[role], filled)
        for disc in body.discs:
            self.circle(*disc, role, filled)

    def robot(self, robot: SceneBody, role: Role, label: str) -> None:
        """A solid shape with a bright wedge that points ahead, at least a few pixels large."""
        self.body(robot, role, filled=True)
        extent, (x, y) = robot.extent, robot.extent.middle
        size = max(extent.width, extent.height, 6 * self._camera.cell_width) / 2
        wedge = ((x + size * 1.4, y), (x - size * 0.5, y + size * 0.6), (x - size * 0.5, y - size * 0.6))
        corners = self._project(np.array([robot.pose.transform_point(*corner) for corner in wedge])).tolist()
        self._draw.polygon(
            [(x, y) for x, y in corners],
            fill=self._colors[Role.EMPTY],
            outline=self._colors[role],
            width=SUPERSAMPLING,
        )
        if label:
            self.text(*robot.pose.transform_point(x - size * 2, y), label)

    def arrows(self, arrows: FloatArray) -> None:
        """Draws arrows as long as they are strong, at most a twentieth of the picture."""
        longest = max(self._camera.bounds.width, self._camera.bounds.height) / 20
        strongest = max(float(arrows[:, 4].max(initial=0.0)), 1e-12)
        for x, y, dx, dy, strength in arrows.tolist():
            length = longest * strength / strongest / (float(np.hypot(dx, dy)) or 1.0)
            tip = x + dx * length, y + dy * length
            left = tip[0] - (dx - 0.4 * dy) * length * 0.3, tip[1] - (dy + 0.4 * dx) * length * 0.3
            right = tip[0] - (dx + 0.4 * dy) * length * 0.3, tip[1] - (dy - 0.4 * dx) * length * 0.3
            self.lines(np.array(((x, y, *tip), (*left, *tip), (*right, *tip))), Role.FIELD)

    def cross(self, x: float, y: float) -> None:
        size = 4 * self._camera.cell_width
        strokes = ((x - size, y - size, x + size, y + size), (x - size, y + size, x + size, y - size))
        self.lines(np.array(strokes), Role.CONTACT, width=1.5)

    def text(self, x: float, y: float, text: str, role: Role = Role.TEXT) -> None:
        ((column, row),) = self._project(np.array([(x, y)])).tolist()
        self._draw.text((column, row), text, self._colors[role], anchor="mm", font_size=11 * SUPERSAMPLING)

    def _shape(self, corners: FloatArray, color: Color, filled: bool) -> None:
        dots = [(x, y) for x, y in self._project(corners).tolist()]
        self._draw.polygon(dots, fill=color if filled else None, outline=color, width=SUPERSAMPLING)

    def _project(self, points: FloatArray) -> FloatArray:
        return self._camera.project(points, SUPERSAMPLING, SUPERSAMPLING)
