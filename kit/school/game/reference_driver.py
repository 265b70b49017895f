"""The reference driver of the levels: it knows the map and follows the shortest path that keeps clear of walls without a
collision. A level's par is set by its time, and its drive is the ghost to race.

Pure pursuit (Coulter 1992, "Implementation of the Pure Pursuit Path Tracking Algorithm", section 2): aim at a point of
the path a little ahead, and turn in place first where that lies far to the side.
"""

from __future__ import annotations

import math
from typing import Final, NamedTuple

from kit.geometry import wrap_angle
from kit.learning.environment.batch_map import BatchMap, batch_map_of_world
from kit.learning.environment.distance_field import CELL, DistanceField, compute_distance_field
from kit.msg.geometry_msgs import Twist, Vector3
from kit.run.scenario import Scenario
from kit.run.session import Session

MAX_SPEED: Final = 0.5
"""[m/s]"""
MAX_TURN_RATE: Final = 1.57
"""[rad/s]"""
LOOKAHEAD: Final = 0.2
"""Distance along the path to the point it aims at [m]."""
WALL_CLEARANCE: Final = 0.35
"""Preferred distance from walls [m]; nearer to them, a metre of path costs up to ``MAX_WALL_COST``."""
MAX_WALL_COST: Final = 12.0
TURN_IN_PLACE_ANGLE: Final = 0.5
"""Heading error beyond which it turns in place first [rad]."""
CONTROL_TICKS: Final = 5
"""Ticks between two commands."""


class AimPoint(NamedTuple):
    x: float
    y: float


class ReferenceDriver:
    """Drives the robot of a session to its target. Unlike students' programs it knows the whole world."""

    def __init__(self, session: Session) -> None:
        """Raises ValueError for a scenario without robot or target, or a world in which no path can be found."""
        scenario = session.scenario
        if scenario.robot is None or scenario.case is None:
            raise ValueError(f"{scenario.title}: nothing says from where to where")
        self._session = session
        self._robot = scenario.robot
        self._distance_field: DistanceField = compute_distance_field(
            _batch_map(scenario), scenario.case.target, WALL_CLEARANCE, MAX_WALL_COST
        )
        self._target = AimPoint(*scenario.case.target)

    def exchange(self) -> bool:
        """Publishes a velocity command every ``CONTROL_TICKS`` ticks; returns False, for it has no more messages."""
        session = self._session
        if session.runner.simulation.tick % CONTROL_TICKS:
            return False
        command = self._command()
        for topic in session.command_topics(self._robot):
            session.runner.accept(topic, command)
        return False

    def _command(self) -> Twist:
        pose = self._session.runner.simulation.pose(self._robot)
        aim_point = self._aim_point(pose.x, pose.y)
        heading_error = wrap_angle(math.atan2(aim_point.y - pose.y, aim_point.x - pose.x) - pose.theta)
        turn = max(-MAX_TURN_RATE, min(MAX_TURN_RATE, 4.0 * heading_error))
        if abs(heading_error) > TURN_IN_PLACE_ANGLE:
            return Twist(angular=Vector3(z=math.copysign(MAX_TURN_RATE, heading_error)))
        speed_factor = max(0.3, 1.0 - abs(heading_error) / TURN_IN_PLACE_ANGLE)
        return Twist(linear=Vector3(x=MAX_SPEED * speed_factor), angular=Vector3(z=turn))

    def _aim_point(self, x: float, y: float) -> AimPoint:
        """The point of the shortest path ``LOOKAHEAD`` metres ahead of a position."""
        rows, columns = self._distance_field.values.shape
        corner = self._distance_field.origin
        column = min(max(round((x - corner[0]) / CELL), 0), columns - 1)
        row = min(max(round((y - corner[1]) / CELL), 0), rows - 1)
        distance = 0.0
        while distance < LOOKAHEAD:
            beside = [
                (float(self._distance_field.values[r, c]), r, c)
                for r in range(max(0, row - 1), min(rows, row + 2))
                for c in range(max(0, column - 1), min(columns, column + 2))
            ]
            least, r, c = min(beside)
            if (r, c) == (row, column) or least <= 0.0:
                return self._target
            distance += CELL * math.hypot(r - row, c - column)
            row, column = r, c
        return AimPoint(corner[0] + CELL * column, corner[1] + CELL * row)


def _batch_map(scenario: Scenario) -> BatchMap:
    return batch_map_of_world(scenario.world, scenario.name, (scenario.robot,))
