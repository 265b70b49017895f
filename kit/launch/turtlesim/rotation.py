"""The action ``rotate_absolute`` of one turtle: turns it to a heading."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, Final

from kit.launch.turtlesim.turtle import Turtle
from kit.msg.turtlesim import RotateAbsolute
from kit.ros.action.server import ActionServer, CancelResponse, ServerGoalHandle
from kit.ros.execution.task import Future
from kit.ros.node.node import Node

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
