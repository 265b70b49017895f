"""A turtle: where it is, how it moves by its commands, and how it turns to a heading that an action asks for."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

from kit.geometry import Pose
from kit.launch.turtlesim.paper import SIDE_M, Paper, Pen
from kit.msg.turtlesim import RotateAbsolute
from kit.ros.action.server import ActionServer, CancelResponse, ServerGoalHandle
from kit.ros.execution.task import Future
from kit.ros.node.node import Node

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
    """An angle [rad] wrapped to -pi to pi."""
    return math.remainder(angle, 2 * math.pi)


TOLERANCE: Final = 0.02
"""How near the heading must come [rad]."""
TURN: Final = 1.0
"""How fast it turns [rad/s]."""


class Rotation:
    """The action server and the goal that it pursues; a new goal aborts the one before."""

    def __init__(self, node: Node, turtle: Turtle) -> None:
        self._node, self._turtle = node, turtle
        self._goal: Any = None
        self._outcome: Future[Any] = Future()
        self._start = 0.0
        self._server = ActionServer(
            node,
            RotateAbsolute,
            f"{turtle.name}/rotate_absolute",
            execute_callback=self._execute,
            handle_accepted_callback=self._accept,
            cancel_callback=lambda goal: CancelResponse.ACCEPT,
        )

    def step(self, now_ns: int) -> None:
        """Commands the turtle for the next step, or ends the goal."""
        goal = self._goal
        if goal is None:
            return
        if goal.is_cancel_requested:
            self._node.get_logger().info("Rotation goal canceled")
            self._end(ServerGoalHandle.canceled)
            return
        remaining = math.remainder(goal.request.theta - self._turtle.pose.theta, 2 * math.pi)
        goal.publish_feedback(RotateAbsolute.Feedback(remaining=remaining))
        if abs(remaining) < TOLERANCE:
            self._node.get_logger().info("Rotation goal completed successfully")
            self._end(ServerGoalHandle.succeed)
        else:
            self._turtle.command(0.0, 0.0, math.copysign(TURN, remaining), now_ns)

    def destroy(self) -> None:
        """Ends the goal and leaves the graph."""
        if self._goal is not None:
            self._end(ServerGoalHandle.abort)
        self._server.destroy()

    def _accept(self, goal: Any) -> None:
        if self._goal is not None:
            self._node.get_logger().warning(
                "Rotation goal received before a previous goal finished. Aborting previous goal"
            )
            self._end(ServerGoalHandle.abort)
        self._goal, self._outcome = goal, Future()
        self._start = self._turtle.pose.theta
        goal.execute()

    async def _execute(self, goal: Any) -> RotateAbsolute.Result:
        outcome, start = self._outcome, self._start
        end = await outcome
        assert end is not None  # only ``_end`` sets it
        end(goal)
        return RotateAbsolute.Result(delta=math.remainder(start - self._turtle.pose.theta, 2 * math.pi))

    def _end(self, outcome: Callable[[ServerGoalHandle], None]) -> None:
        """``outcome``: what is called on the goal."""
        self._goal = None
        now_ns = self._node.get_clock().now().nanoseconds
        self._turtle.command(0.0, 0.0, 0.0, now_ns)
        self._outcome.set_result(outcome)
