"""The reference driver of the levels: it knows the map, follows the shortest way that keeps clear of walls, and touches
nothing. What it needs is what a level's par is measured by, and its drive is the ghost to race.

Pure pursuit (Coulter 1992, "Implementation of the Pure Pursuit Path Tracking Algorithm", section 2): aim at a point of
the way a little ahead, and turn in place first where that lies far to the side.
"""

from __future__ import annotations

import math
from typing import Final, NamedTuple

from kit.geometry import wrap_angle
from kit.learning.environment.batch_map import BatchMap, batch_map_of_world
from kit.learning.environment.distance_field import CELL, DistanceField, compute_distance_field
from kit.msg.geometry_msgs import Twist, Vector3
from kit.run.scenario import Place
from kit.run.session import Session

SPEED: Final = 0.5
"""m/s"""
TURN: Final = 1.57
"""rad/s"""
AHEAD: Final = 0.2
"""m along the way: how far ahead it aims."""
CLEAR: Final = 0.35
"""m: it keeps so far from walls where there is room; nearer, a metre counts for up to ``DEAREST``."""
DEAREST: Final = 12.0
ASIDE: Final = 0.5
"""rad: farther to the side than this it turns in place first."""
EVERY: Final = 5
"""Ticks between two decisions."""


class Aim(NamedTuple):
    x: float
    y: float


class Guide:
    """Drives the robot of a session to its target. It is told the world; students' programs are not."""

    def __init__(self, session: Session) -> None:
        """Raises ValueError where the place has no robot or no target, or a world the way cannot be found in."""
        place = session.place
        if place.robot is None or place.case is None:
            raise ValueError(f"{place.title}: nothing says from where to where")
        self._session = session
        self._robot = place.robot
        self._table: DistanceField = compute_distance_field(_ground(place), place.case.target, CLEAR, DEAREST)
        self._target = Aim(*place.case.target)

    def exchange(self) -> bool:
        """Tells the wheels what to do, a few times a second."""
        session = self._session
        if session.runner.simulation.tick % EVERY:
            return False
        command = self._command()
        for topic in session.command_topics(self._robot):
            session.runner.accept(topic, command)
        return False

    def _command(self) -> Twist:
        pose = self._session.runner.simulation.pose(self._robot)
        aim = self._aim(pose.x, pose.y)
        aside = wrap_angle(math.atan2(aim.y - pose.y, aim.x - pose.x) - pose.theta)
        turn = max(-TURN, min(TURN, 4.0 * aside))
        if abs(aside) > ASIDE:
            return Twist(angular=Vector3(z=math.copysign(TURN, aside)))
        slow = max(0.3, 1.0 - abs(aside) / ASIDE)
        return Twist(linear=Vector3(x=SPEED * slow), angular=Vector3(z=turn))

    def _aim(self, x: float, y: float) -> Aim:
        """The point of the shortest way that lies a little ahead."""
        rows, columns = self._table.values.shape
        corner = self._table.corner
        column = min(max(round((x - corner[0]) / CELL), 0), columns - 1)
        row = min(max(round((y - corner[1]) / CELL), 0), rows - 1)
        gone = 0.0
        while gone < AHEAD:
            beside = [
                (float(self._table.values[r, c]), r, c)
                for r in range(max(0, row - 1), min(rows, row + 2))
                for c in range(max(0, column - 1), min(columns, column + 2))
            ]
            least, r, c = min(beside)
            if (r, c) == (row, column) or least <= 0.0:
                return self._target
            gone += CELL * math.hypot(r - row, c - column)
            row, column = r, c
        return Aim(corner[0] + CELL * column, corner[1] + CELL * row)


def _ground(place: Place) -> BatchMap:
    return batch_map_of_world(place.world, place.name, (place.robot,))
