"""One turtle of turtlesim: where it is, how it moves, and what it draws."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from kit.geometry import Pose
from kit.launch.turtlesim.paper import SIDE_M, Paper, Pen

COMMAND_S: Final = 1.0
"""How long a command holds [s]."""


@dataclass(frozen=True, slots=True)
class Teleport:
    """A jump: to a pose, or by a turn and a distance from where it is."""

    pose: Pose
    distance: float | None = None
    """None: absolute; else how far ahead [m] after turning by the pose's heading."""


class Turtle:
    """Moves as turtlesim's does: at the commanded speed for a second, clamped at the field's edge, through others.

    ``warn`` receives the text of the warning for each step at the wall.
    """

    def __init__(self, name: str, pose: Pose, paper: Paper, warn: Callable[[str], object]) -> None:
        self.name = name
        self.pose = pose
        self.pen = Pen()
        self.forward = self.sideways = self.turn = 0.0
        """The commanded speeds [m/s, rad/s]."""
        self._paper, self._warn = paper, warn
        self._commanded_ns = 0
        self._teleports: list[Teleport] = []

    @property
    def speed(self) -> float:
        """Its speed over ground [m/s]."""
        return math.hypot(self.forward, self.sideways)

    def command(self, forward: float, sideways: float, turn: float, now_ns: int) -> None:
        """Sets the speeds for a second."""
        self.forward, self.sideways, self.turn = forward, sideways, turn
        self._commanded_ns = now_ns

    def teleport(self, teleport: Teleport) -> None:
        """Jumps at the next step; the pen draws there."""
        self._teleports.append(teleport)

    def step(self, dt: float, now_ns: int) -> None:
        """Moves for ``dt`` [s]."""
        for teleport in self._teleports:
            self._jump(teleport)
        self._teleports.clear()
        if now_ns - self._commanded_ns > COMMAND_S * 1e9 or now_ns < self._commanded_ns:
            self.command(0.0, 0.0, 0.0, now_ns)
        before = self.pose
        theta = _normalized(before.theta + self.turn * dt)
        cos, sin = math.cos(theta), math.sin(theta)
        x = before.x + (cos * self.forward - sin * self.sideways) * dt
        y = before.y + (sin * self.forward + cos * self.sideways) * dt
        if not (0 <= x <= SIDE_M and 0 <= y <= SIDE_M):
            # turtlesim counts y from the top here.
            self._warn(f"Oh no! I hit the wall! (Clamping from [x={x:f}, y={SIDE_M - y:f}])")
        self._move(Pose(min(max(x, 0.0), SIDE_M), min(max(y, 0.0), SIDE_M), theta))

    def _jump(self, teleport: Teleport) -> None:
        x, y, theta = teleport.pose
        if teleport.distance is not None:
            theta += self.pose.theta
            x = self.pose.x + math.cos(theta) * teleport.distance
            y = self.pose.y + math.sin(theta) * teleport.distance
        else:
            y = min(y, SIDE_M)
        self._move(Pose(x, y, theta))

    def _move(self, pose: Pose) -> None:
        before, self.pose = self.pose, pose
        if before[:2] != pose[:2]:
            self._paper.draw_line(self.name, before[:2], pose[:2], self.pen)


def _normalized(angle: float) -> float:
    """The same angle from -pi to pi [rad]."""
    return math.remainder(angle, 2 * math.pi)
