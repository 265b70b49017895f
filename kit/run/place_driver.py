"""Drives a robot along a way, such as the widest one to a place that the user has clicked; any other driver ends it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

from kit.fields.occupancy_grid import OccupancyGrid, occupancy_grid_of
from kit.geometry import wrap_angle
from kit.mapmaking.route import NEAREST_TARGET, NoRoute, Point, clear_of_walls, widest_route
from kit.msg.geometry_msgs import Twist
from kit.run.lockstep import Observer

if TYPE_CHECKING:
    from kit.run.session import Session
    from kit.sim.simulation import Simulation

SPEED: Final = 0.4
"""[m/s]"""
TURN_RATE: Final = 1.5
"""Highest turn rate [rad/s]."""
TURN_GAIN: Final = 4.0
"""rad/s for each radian that the heading is off."""
LOOKAHEAD: Final = 0.25
"""Distance along the way to the point it aims at [m]."""
ARRIVAL: Final = 0.06
"""It has arrived within this distance [m]."""
TURN_IN_PLACE: Final = 0.8
"""Where the heading is off by more [rad], it turns before it drives on."""


class WayDriver(Observer):
    """Drives the session's robot from point to point. Raises ValueError for a world without a robot."""

    def __init__(self, session: Session, points: Sequence[tuple[float, float]]) -> None:
        """``points``: of the way, [m, m] each."""
        if session.scenario.robot is None:
            raise ValueError("There is no robot to drive here.")
        self._session = session
        self._robot = session.scenario.robot
        self._topics = session.command_topics(self._robot)
        self._points = points
        self._at = 0
        self.is_done = False

    def cancel(self) -> None:
        """Leaves the robot to others. From any thread."""
        self.is_done = True

    def on_step(self, simulation: Simulation) -> None:
        if self.is_done:
            return
        if self._session.controller is not None:  # a program, or the keys
            self.is_done = True
            return
        pose = simulation.pose(self._robot)
        while self._at < len(self._points) - 1 and math.dist(pose[:2], self._points[self._at]) < LOOKAHEAD:
            self._at += 1
        x, y = self._points[self._at]
        command = Twist()
        if math.dist(pose[:2], self._points[-1]) <= ARRIVAL:
            self.is_done = True
        else:
            error = wrap_angle(math.atan2(y - pose.y, x - pose.x) - pose.theta)
            command.angular.z = min(max(TURN_GAIN * error, -TURN_RATE), TURN_RATE)
            command.linear.x = SPEED * max(0.0, 1.0 - abs(error) / TURN_IN_PLACE)
        for topic in self._topics:
            self._session.runner.accept(topic, command)


class PlaceDriver(WayDriver):
    """Drives the session's robot to a place. Making it takes a moment, for the way is found; raises NoRoute, and ValueError
    for a world without walls or without a robot."""

    def __init__(self, session: Session, place: tuple[float, float]) -> None:
        """``place``: [m, m]."""
        scenario = session.scenario
        if scenario.robot is None:
            raise ValueError("There is no robot to drive here.")
        pose = session.runner.simulation.pose(scenario.robot)
        grid = occupancy_grid_of(scenario.world)
        out = clear_of_walls(grid, pose[:2])
        super().__init__(session, (*out, *_way(grid, out[-1], place)))


def _way(grid: OccupancyGrid, start: Point, place: Point) -> tuple[Point, ...]:
    """The widest way, and at its end what leads nearer to the walls. Raises NoRoute."""
    if not grid.inside[grid.cell_at(*place)]:
        raise NoRoute("There is no floor where you clicked.")
    back = clear_of_walls(grid, place)[::-1]
    if math.dist(start, back[0]) < NEAREST_TARGET:
        return back
    try:
        return (*widest_route(grid, start, back[0]).points, *back)
    except NoRoute:
        raise NoRoute("The robot does not fit through any way to where you clicked.") from None
