"""A tidy driver, the measure of the game's medals: pure pursuit along the shortest path, full speed, exact keys.

It knows the whole map, as a player who looks at it does, and presses the three keys of a hand without any delay: forward,
left, right, each either held or not. It plans nothing: it does not cut corners, wait, brake or look at what moves. This
file was fixed before the medals were set (``kit/school/game/player_progress.py``) and must not be changed to suit them.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from types import SimpleNamespace

from kit.geometry import Pose, wrap_angle
from kit.learning.environment.distance_field import CELL, DistanceField, compute_distance_field
from kit.msg.geometry_msgs import Twist, Vector3
from kit.run.session import Session
from kit.school.game.levels import PAIR_SPEED

SPEED, TURN_RATE = 0.5, 1.5
"""What the keys of ``teleop`` give [m/s, rad/s]."""
PAIR_TURN_RATE = 0.8
"""What those of ``teleop_pair`` give; the outer one of a bend drives at the pair's full speed [rad/s]."""
LOOKAHEAD = 0.4
"""Distance along the path to the point it aims at [m]."""
TURN_IN_PLACE_ANGLE = 0.9
"""Beyond this heading error it lets go of the forward key [rad]."""
STEERING_TOLERANCE = 0.03
"""Within this heading error it presses neither left nor right [rad]."""
CLEARANCE, WALL_PRICE = 0.22, 8.0
"""The shortest path keeps this far from walls [m] where it can."""
ARRIVAL_DISTANCE = 0.25
"""From here it goes on to the next target, where there are several [m]."""


class TidyDriver:
    """Drives one robot, or two side by side as if they were one, to each of ``targets`` in turn."""

    def __init__(self, session: Session, targets: Sequence[tuple[float, float]]) -> None:
        self._session = session
        self._models = session.scenario.partners
        self._targets = list(targets)
        starts = session.scenario.starts
        self._half_gap = 0.5 * math.dist(starts[0][:2], starts[1][:2]) if len(starts) > 1 else 0.0
        self._walls = SimpleNamespace(walls=session.scenario.world.wall_segments)
        self._field: DistanceField | None = None

    def exchange(self) -> bool:
        """Called before every tick; has no more messages afterwards."""
        speed, turn = self.keys(self._pose())
        for model, offset in zip(self._models, (-self._half_gap, self._half_gap), strict=False):
            command = Twist(linear=Vector3(x=speed + turn * offset), angular=Vector3(z=turn))
            for topic in self._session.command_topics(model):
                self._session.runner.accept(topic, command)
        return False

    def keys(self, pose: Pose) -> tuple[float, float]:
        """The speed and turn rate of the keys that are held."""
        speed_limit, turn_limit = (
            (SPEED, TURN_RATE) if len(self._models) == 1 else (PAIR_SPEED, PAIR_TURN_RATE)
        )
        if len(self._targets) > 1 and math.dist(pose[:2], self._targets[0]) < ARRIVAL_DISTANCE:
            self._targets.pop(0)
            self._field = None
        if self._field is None:
            self._field = compute_distance_field.__wrapped__(
                self._walls, self._targets[0], CLEARANCE + self._half_gap, WALL_PRICE
            )
        x, y = self._aim_point(self._field, pose.x, pose.y)
        error = wrap_angle(math.atan2(y - pose.y, x - pose.x) - pose.theta)
        turn = 0.0 if abs(error) < STEERING_TOLERANCE else math.copysign(turn_limit, error)
        return (speed_limit - abs(turn) * self._half_gap if abs(error) < TURN_IN_PLACE_ANGLE else 0.0), turn

    def _pose(self) -> Pose:
        """The robot's, or that of the point between two."""
        poses = [self._session.runner.simulation.pose(name) for name in self._models]
        x, y = (sum(pose[axis] for pose in poses) / len(poses) for axis in (0, 1))
        return Pose(x, y, poses[0].theta)

    def _aim_point(self, field: DistanceField, x: float, y: float) -> tuple[float, float]:
        rows, columns = field.values.shape
        column = min(max(round((x - field.origin[0]) / CELL), 0), columns - 1)
        row = min(max(round((y - field.origin[1]) / CELL), 0), rows - 1)
        distance = 0.0
        while distance < LOOKAHEAD:
            beside = [
                (float(field.values[r, c]), r, c)
                for r in range(max(0, row - 1), min(rows, row + 2))
                for c in range(max(0, column - 1), min(columns, column + 2))
            ]
            least, r, c = min(beside)
            if (r, c) == (row, column) or least <= 0.0:
                return self._targets[0]
            distance += CELL * math.hypot(r - row, c - column)
            row, column = r, c
        return field.origin[0] + CELL * column, field.origin[1] + CELL * row
