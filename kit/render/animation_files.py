"""Scenes over time as files: an asciicast of characters (version 2), or an SVG picture that moves by itself (SMIL)."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from html import escape
from typing import Final

import numpy as np

from kit.arrays import FloatArray
from kit.render.encode import Frame, changed_spans
from kit.render.image import IMAGE_THEMES, Color, path_role
from kit.render.palettes import Palette
from kit.render.role_looks import ROLE_LOOKS, LineStyle, RoleStyle
from kit.render.roles import ROBOT_ROLES, Role
from kit.render.scene import Disc, Scene, SceneBody, SceneBounds, SceneMark, ScenePath

_ANSI_NAMES = ("black", "red", "green", "yellow", "blue", "magenta", "cyan", "white")
_BEGIN = "\x1b[?25l\x1b[2J"
_END = "\x1b[0m\x1b[?25h"
_MERGE_GAP = 8
"""Unchanged characters that are written again: after a move of the cursor the colours are named again."""


def asciicast_lines(
    frames: Iterable[tuple[float, Frame]], palette: Palette, title: str = ""
) -> Iterator[str]:
    """The lines of the file: a header, then for each frame its time [s] and the characters that have changed.

    ``frames``: times [s] that never fall, and frames of one size. ValueError without a frame.

    >>> from kit.render.roles import ANSI_PALETTE
    >>> header, first, *_ = asciicast_lines([(0.0, Frame.empty(80, 24))], ANSI_PALETTE, "A blank screen")
    >>> json.loads(header)["width"], json.loads(first)[:2]
    (80, [0.0, 'o'])
    """
    before, time_s = None, 0.0
    for time_s, frame in frames:
        text = _changes_text(before, frame, palette)
        if before is None:
            rows, columns = frame.shape
            yield json.dumps({"version": 2, "width": columns, "height": rows, "title": title})
            text = _BEGIN + text
        if text:
            yield json.dumps([round(time_s, 3), "o", text], ensure_ascii=False)
        before = frame
    if before is None:
        raise ValueError("no frames")
    yield json.dumps([round(time_s, 3), "o", _END])


def _changes_text(before: Frame | None, after: Frame, palette: Palette) -> str:
    """Moves the cursor to each span that differs and writes it there."""
    parts = []
    for span in changed_spans(before, after, _MERGE_GAP):
        parts.append(f"\x1b[{span.row + 1};{span.start + 1}H")
        parts += [
            f"\x1b[{_graphic_codes(palette[Role(run.fg)], palette[Role(run.bg)])}m{run.text}"
            for run in after.runs(*span)
        ]
    return "".join(parts)


def _graphic_codes(foreground: RoleStyle, background: RoleStyle) -> str:
    """The parameters of SGR: everything off, then what the two styles say."""
    codes = ["0", *(["1"] if foreground.bold else []), *(["2"] if foreground.dim else [])]
    for style, first in ((foreground, 30), (background, 40)):
        color = style.color
        if isinstance(color, str):
            name = color.removeprefix("bright_")
            codes.append(str(first + (60 if name != color else 0) + _ANSI_NAMES.index(name)))
        elif isinstance(color, int):
            codes.append(f"{first + 8};5;{color}")
        elif color is not None:
            codes.append(f"{first + 8};2;{';'.join(map(str, color))}")
    return ";".join(codes)


_NOWHERE = "M0 0"
LEAST_RADIUS: Final = 2.0
"""Of a disc [pixels]."""
_DASHES: Mapping[LineStyle, str] = {
    "solid": "",
    "dashed": "6 3",
    "long-dashed": "12 3",
    "dotted": "2 3",
    "sparse": "2 8",
    "paired": "2 2 2 6",
}


def svg_picture(
    scene: Scene,
    *,
    size: tuple[int, int] = (640, 480),
    title: str = "",
    theme: Mapping[Role, Color] = IMAGE_THEMES["light"],
) -> str:
    """The whole file: walls, targets, paths, marks and contacts of one scene; bodies are not drawn.

    ``size``: at most this wide and high [pixels], as the world's shape asks for.

    >>> svg_picture(Scene(), title="nothing")[:4]
    '<svg'
    """
    drawing = _Drawing(scene.bounds, size, theme)
    width, height = drawing.width, drawing.height
    shape = f'viewBox="0 0 {width} {height}" width="{width}" height="{height}"'
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" {shape} role="img" fill="none" stroke-linejoin="round">',
        f"<title>{escape(title)}</title>",
        f'<rect width="{width}" height="{height}" fill="{drawing.color(Role.EMPTY)}"/>',
        *(drawing.path(path) for path in scene.paths),
        *(drawing.target(target) for target in scene.targets),
        f'<path d="{drawing.segments(scene.walls)}" stroke="{drawing.color(Role.WALL)}" stroke-width="1.5"/>',
        *(drawing.mark(mark) for mark in scene.marks),
        *(drawing.cross(x, y) for x, y in scene.contacts.tolist()),
    ]
    return "\n".join([*parts, "</svg>", ""])


def svg_animation(
    scenes: Iterable[Scene],
    interval_s: float,
    *,
    size: tuple[int, int] = (640, 480),
    title: str = "",
    theme: Mapping[Role, Color] = IMAGE_THEMES["light"],
) -> str:
    """The whole file: walls, targets and robots' ways as lines, and every body moving, again and again.

    ``scenes``: ``interval_s`` seconds apart; walls are those of the first. ``size``: at most this wide
    and high [pixels], as the world's shape asks for. ValueError without a scene.

    >>> svg_animation([Scene(), Scene()], 0.1)[:4]
    '<svg'
    """
    shown = list(scenes)
    if not shown:
        raise ValueError("no scenes")
    drawing = _Drawing(shown[0].bounds, size, theme)
    first, duration_s = shown[0], interval_s * len(shown)
    width, height = drawing.width, drawing.height
    shape = f'viewBox="0 0 {width} {height}" width="{width}" height="{height}"'
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" {shape} role="img" fill="none" stroke-linejoin="round">',
        f"<title>{escape(title)}</title>",
        f'<rect width="{width}" height="{height}" fill="{drawing.color(Role.EMPTY)}"/>',
        *(drawing.way(way, number) for number, way in enumerate(_driven_paths(shown))),
        *(
            line
            for target in dict.fromkeys(target for scene in shown for target in scene.targets)
            for line in drawing.moving(
                [drawing.disc(*target) if target in scene.targets else _NOWHERE for scene in shown],
                duration_s,
                drawing.target_style,
            )
        ),
        f'<path d="{drawing.segments(first.walls)}" stroke="{drawing.color(Role.WALL)}" stroke-width="1.5"/>',
    ]
    for model, robot in _numbered_models(shown):
        role = Role.BODY if robot is None else ROBOT_ROLES[robot % len(ROBOT_ROLES)]
        style = f'stroke="{drawing.color(role)}" stroke-width="1.5"'
        if robot is not None:
            style += f' fill="{drawing.color(role)}"'
        parts += drawing.moving(_outlines(shown, model, drawing), duration_s, style)
        if robot is not None:
            ahead = f'stroke="{drawing.color(Role.EMPTY)}" stroke-width="2"'
            parts += drawing.moving(_headings(shown, model, drawing), duration_s, ahead)
    return "\n".join([*parts, "</svg>", ""])


class _Drawing:
    """World coordinates [m] as places on the paper [pixels]."""

    def __init__(self, bounds: SceneBounds, size: tuple[int, int], theme: Mapping[Role, Color]) -> None:
        margin = min(size) / 40
        across, down = (each - 2 * margin for each in size)
        self._scale = min(across / max(bounds.width, 1e-6), down / max(bounds.height, 1e-6))
        self._left, self._top, self._margin = bounds.left, bounds.top, margin
        self._theme = theme
        self.width = max(1, round(bounds.width * self._scale + 2 * margin))
        self.height = max(1, round(bounds.height * self._scale + 2 * margin))

    def color(self, role: Role) -> str:
        return "#{:02x}{:02x}{:02x}".format(*self._theme[role])

    def segments(self, segments: FloatArray) -> str:
        finite = segments[np.isfinite(segments).all(axis=1)]
        return "".join(
            f"M{self._path_point(x1, y1)}L{self._path_point(x2, y2)}" for x1, y1, x2, y2 in finite.tolist()
        )

    def line(self, points: FloatArray) -> str:
        return "M" + "L".join(self._path_point(x, y) for x, y in points.tolist())

    def way(self, points: FloatArray, number: int) -> str:
        role = (Role.TRAIL, Role.TRAIL_2)[number % 2]
        return f'<path d="{self.line(points)}" stroke="{self.color(role)}" stroke-dasharray="1 4"/>'

    def path(self, path: ScenePath) -> str:
        pattern = _DASHES[path.style or ROLE_LOOKS[path_role(path)].line]
        dash = f' stroke-dasharray="{pattern}"' if pattern else ""
        return f'<path d="{self.line(path.points)}" stroke="{self.color(path_role(path))}" stroke-width="1.5"{dash}/>'

    def mark(self, mark: SceneMark) -> str:
        x, y = self._path_point(mark.x, mark.y).split()
        return (
            f'<text x="{x}" y="{y}" fill="{self.color(mark.role)}" font-family="sans-serif" font-size="11" '
            f'text-anchor="middle" dominant-baseline="central">{escape(mark.label)}</text>'
        )

    def cross(self, x: float, y: float) -> str:
        column, row = map(float, self._path_point(x, y).split())
        left, right, top, bottom = column - 5, column + 5, row - 5, row + 5
        lines = (
            f"M{left:.1f} {top:.1f}L{right:.1f} {bottom:.1f}M{left:.1f} {bottom:.1f}L{right:.1f} {top:.1f}"
        )
        return f'<path d="{lines}" stroke="{self.color(Role.CONTACT)}" stroke-width="2.5"/>'

    def target(self, target: Disc) -> str:
        return f'<path d="{self.disc(*target)}" {self.target_style}/>'

    @property
    def target_style(self) -> str:
        return f'stroke="{self.color(Role.TARGET)}" stroke-width="2"'

    def disc(self, x: float, y: float, radius: float) -> str:
        """The shape of a disc that is no smaller than can be seen."""
        radius = max(radius, LEAST_RADIUS / self._scale)
        r = f"{radius * self._scale:.1f}"
        left, right = self._path_point(x - radius, y), self._path_point(x + radius, y)
        return f"M{left}A{r} {r} 0 1 0 {right}A{r} {r} 0 1 0 {left}Z"

    def outline(self, body: SceneBody) -> str:
        if not all(np.isfinite(body.pose)):
            return _NOWHERE
        shapes = [self.line(polygon) + "Z" for polygon in body.polygons]
        shapes += [self.disc(x, y, radius) for x, y, radius in body.discs]
        return "".join(shapes) or _NOWHERE

    def heading(self, body: SceneBody) -> str:
        """The line from the middle of the body to its front."""
        if not all(np.isfinite(body.pose)):
            return _NOWHERE
        extent = body.extent
        ends = (extent.middle, (extent.right, extent.middle[1]))
        return self.line(np.array([body.pose.transform_point(*end) for end in ends]))

    def moving(self, shapes: Sequence[str], duration_s: float, style: str) -> Iterator[str]:
        """One path that takes these shapes one after the other."""
        if len(set(shapes)) == 1:
            yield f'<path d="{shapes[0]}" {style}/>'
            return
        yield f'<path d="{shapes[0]}" {style}><animate attributeName="d" calcMode="discrete"'
        yield f'dur="{duration_s:.2f}s" repeatCount="indefinite" values="{";".join(shapes)}"/></path>'

    def _path_point(self, x: float, y: float) -> str:
        return (
            f"{(x - self._left) * self._scale + self._margin:.1f} "
            f"{(self._top - y) * self._scale + self._margin:.1f}"
        )


def _numbered_models(scenes: Sequence[Scene]) -> list[tuple[str, int | None]]:
    """All models there ever are, with the number of each robot from 0; None for what is no robot."""
    robots = list(dict.fromkeys(body.model for scene in scenes for body in scene.robots))
    every = dict.fromkeys(body.model for scene in scenes for body in scene.bodies)
    others = [model for model in every if model not in robots]
    return [*((model, None) for model in others), *((model, number) for number, model in enumerate(robots))]


def _body_of_model(scene: Scene, model: str) -> SceneBody | None:
    return next((body for body in scene.bodies if body.model == model), None)


def _outlines(scenes: Sequence[Scene], model: str, drawing: _Drawing) -> list[str]:
    bodies = (_body_of_model(scene, model) for scene in scenes)
    return [_NOWHERE if body is None else drawing.outline(body) for body in bodies]


def _headings(scenes: Sequence[Scene], model: str, drawing: _Drawing) -> list[str]:
    bodies = (_body_of_model(scene, model) for scene in scenes)
    return [_NOWHERE if body is None else drawing.heading(body) for body in bodies]


def _driven_paths(scenes: Sequence[Scene]) -> list[FloatArray]:
    """Each robot's way, (k, 2) [m], of those that have moved."""
    ways: dict[str, list[tuple[float, float]]] = {}
    for scene in scenes:
        for robot in scene.robots:
            if np.isfinite(robot.pose).all():
                ways.setdefault(robot.model, []).append((robot.pose.x, robot.pose.y))
    return [np.array(way) for way in ways.values() if len(set(way)) > 1]
