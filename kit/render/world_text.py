"""Describes the world in words and in plain characters: for screen readers, pipes and logs."""

from __future__ import annotations

import math
import shutil
from collections.abc import Iterator, Sequence
from typing import TextIO

import numpy as np

from kit.geometry import Pose, whole_degrees, wrap_angle
from kit.render.camera import Camera
from kit.render.clearance import nearest_wall
from kit.render.encode import ENCODERS, AsciiEncoder, Encoder
from kit.render.painter import Painter
from kit.render.scene import Scene, SceneBody

SIDES = ("ahead", "ahead left", "left", "behind left", "behind", "behind right", "right", "ahead right")
"""Sides in eighths of a turn, counter-clockwise from the heading."""


def scene_rows(scene: Scene, columns: int, rows: int, encoder: Encoder | None = None) -> list[str]:
    """The whole scene as rows of characters without colours, by default in ASCII."""
    return Painter(encoder or AsciiEncoder()).paint(scene, Camera.fit(scene.bounds, columns, rows)).rows()


def describe_scene(scene: Scene) -> str:
    """Describes the scene robot by robot, one line each: the target's distance and bearing
    (left is positive), the nearest wall's distance from the hull and side, whether it touches something."""
    robots = scene.robots
    if not robots:
        return "no robot"
    lines = ["; ".join(_robot_facts(robot, scene)) for robot in robots]
    if len(robots) == 1:
        return lines[0]
    return "\n".join(f"{robot.model}: {line}" for robot, line in zip(robots, lines, strict=True))


def _robot_facts(robot: SceneBody, scene: Scene) -> Iterator[str]:
    pose = robot.pose
    if scene.targets:
        target = min(scene.targets, key=lambda disc: math.hypot(disc.x - pose.x, disc.y - pose.y))
        away = math.hypot(target.x - pose.x, target.y - pose.y)
        degrees = whole_degrees(_bearing(pose, target.x, target.y))
        reached = ", reached" if away <= target.radius else ""
        yield f"target {away:.1f} m at {degrees:+d} deg{reached}"
    if len(scene.walls):
        distance, point = nearest_wall(robot, scene.walls)
        eighth = round(_bearing(pose, *point) / math.tau * 8) % 8
        yield f"nearest wall {distance:.1f} m {SIDES[eighth]}"
    else:
        yield "no walls"
    touching = np.hypot(*(scene.contacts - pose[:2]).T) if len(scene.contacts) else np.empty(0)
    if (touching <= _outer_radius(robot) + 0.02).any():
        yield "touching"


def _bearing(pose: Pose, x: float, y: float) -> float:
    return wrap_angle(math.atan2(y - pose.y, x - pose.x) - pose.theta)


def _outer_radius(robot: SceneBody) -> float:
    left, bottom, right, top = robot.extent
    return math.hypot(max(-left, right), max(-bottom, top))


UP, CLEAR_LINE, CLEAR_BELOW = "\x1b[{}A", "\x1b[2K", "\x1b[0J"
MAX_ROWS = 30
"""Most rows of a world; a larger terminal leaves the rest free."""


class TerminalPicture:
    """Paints a scene with a line of text below it, each time over the last one.

    Where the output is not a terminal, one picture follows another. Where it cannot say braille, they are in ASCII.
    """

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream
        self._is_terminal = stream.isatty()
        self._painted = 0
        try:
            "⣿".encode(stream.encoding or "ascii")
            self._encoder = ENCODERS["braille"](True)
        except UnicodeEncodeError:
            self._encoder = ENCODERS["ascii"](True)

    def paint(self, scene: Scene, caption: str) -> None:
        """Paints the scene as large as the terminal is, and leaves the cursor on the line below the caption."""
        columns, lines = shutil.get_terminal_size()
        rows = scene_rows(scene, max(10, columns - 1), min(MAX_ROWS, max(4, lines - 2)), self._encoder)
        self._write([*rows, caption[: columns - 1]])

    def _write(self, lines: Sequence[str]) -> None:
        if not self._is_terminal:
            self._stream.write("".join(f"{line}\n" for line in lines))
        else:
            start = UP.format(self._painted) if self._painted else ""
            self._stream.write(start + "".join(f"{CLEAR_LINE}{line}\r\n" for line in lines) + CLEAR_BELOW)
        self._stream.flush()
        self._painted = len(lines)
