"""turtlesim's node: its turtles, what they draw, and its services, topics, actions and parameters, in any graph.

The field is 11.0889 m wide and high; ``turtle1`` starts in its middle. Turtles draw on an image of 500 by 500 dots, as
turtlesim's window has, and the same as strokes that the world view shows. The picture's background is the terminal's
own: the parameters ``background_r``, ``background_g`` and ``background_b`` say what ``color_sensor`` reports where
nothing is drawn, from the next ``clear`` or ``reset`` on. The programs beside it are in ``share/turtlesim``.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, Final

import numpy as np

from kit.geometry import Pose
from kit.msg.geometry_msgs import Twist
from kit.msg.rcl_interfaces import IntegerRange, ParameterDescriptor
from kit.msg.std_srvs import Empty
from kit.msg.turtlesim import Color, Kill, RotateAbsolute, SetPen, Spawn, TeleportAbsolute, TeleportRelative
from kit.msg.turtlesim import Pose as PoseMessage
from kit.render.scene import PenStroke, SceneBody
from kit.ros.action.server import ActionServer, CancelResponse, ServerGoalHandle
from kit.ros.exceptions import InvalidTopicNameException
from kit.ros.execution.context import context_of
from kit.ros.execution.task import Future
from kit.ros.graph.graph import Graph
from kit.ros.node.node import Node

Rgb = tuple[int, int, int]

METER: Final = 45
"""Dots a metre: the height of turtlesim's picture of a turtle."""
DOTS: Final = 500
SIDE_M: Final = (DOTS - 1) / METER
"""Length of the field's sides [m]: 11.0889."""
BACKGROUND: Final[Rgb] = (69, 86, 255)
MAX_POINTS: Final = 20_000
"""Points of strokes that are kept for the view; the oldest go first."""
SPACING_M: Final = 0.05
"""Distance of a stroke's points [m]."""


@dataclass(frozen=True, slots=True)
class Pen:
    """The pen that a turtle draws with."""

    color: Rgb = (179, 184, 255)
    width: int = 3
    """Width in dots."""
    is_down: bool = True


class Paper:
    """The field as the turtles have drawn on it; x to the right and y up [m], from the lower left corner."""

    def __init__(self) -> None:
        self._image = np.zeros((DOTS, DOTS, 3), dtype=np.uint8)
        self._strokes: list[tuple[str, Rgb, list[tuple[float, float]]]] = []
        self.clear(BACKGROUND)

    def clear(self, background: Rgb) -> None:
        """Removes all that was drawn."""
        self._image[:] = background
        self._strokes.clear()

    def draw_line(self, turtle: str, start: tuple[float, float], end: tuple[float, float], pen: Pen) -> None:
        """Draws a straight line of a turtle's pen."""
        if not pen.is_down:
            return
        (column, row), (last_column, last_row) = _dot(*start), _dot(*end)
        count = max(abs(last_column - column), abs(last_row - row)) + 1
        columns = np.linspace(column, last_column, count).round().astype(int)
        rows = np.linspace(row, last_row, count).round().astype(int)
        for across in range(-(pen.width // 2), (pen.width + 1) // 2):
            for down in range(-(pen.width // 2), (pen.width + 1) // 2):
                self._image[np.clip(rows + down, 0, DOTS - 1), np.clip(columns + across, 0, DOTS - 1)] = (
                    pen.color
                )
        self._add_to_stroke(turtle, start, end, pen.color)

    def color_at(self, x: float, y: float) -> Rgb:
        """The colour of the dot at a place [m]."""
        column, row = _dot(x, y)
        red, green, blue = self._image[row, column].tolist()
        return red, green, blue

    @property
    def strokes(self) -> tuple[PenStroke, ...]:
        """All lines, for the view."""
        return tuple(PenStroke(np.array(points), color) for _, color, points in self._strokes)

    def _add_to_stroke(
        self, turtle: str, start: tuple[float, float], end: tuple[float, float], color: Rgb
    ) -> None:
        last = next((each for each in reversed(self._strokes) if each[0] == turtle), None)
        if last is not None and last[1] == color and np.hypot(*np.subtract(start, last[2][-1])) < SPACING_M:
            if np.hypot(*np.subtract(end, last[2][-1])) >= SPACING_M:
                last[2].append(end)
        else:
            self._strokes.append((turtle, color, [start, end]))
        excess = sum(len(points) for _, _, points in self._strokes) - MAX_POINTS
        while excess > 0:
            oldest = self._strokes[0][2]
            if len(oldest) - excess < 2:  # no line is left of it
                del self._strokes[0]
                excess -= len(oldest)
            else:
                del oldest[:excess]
                excess = 0


def _dot(x: float, y: float) -> tuple[int, int]:
    """The column and row of a place's dot."""
    column, row = round(x * METER), round((SIDE_M - y) * METER)
    return min(max(column, 0), DOTS - 1), min(max(row, 0), DOTS - 1)


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


PERIOD_S: Final = 0.016
"""turtlesim moves its turtles and reports their poses so often [s]."""
_SHELL: Final = np.array([(0.28, 0.0), (0.12, 0.2), (-0.16, 0.2), (-0.25, 0.0), (-0.16, -0.2), (0.12, -0.2)])
"""A turtle's outline in its own frame [m]."""


@dataclass(frozen=True, slots=True)
class _Inhabitant:
    """A turtle with what it has in the graph."""

    turtle: Turtle
    rotation: Rotation
    pose_publisher: Any
    color_publisher: Any
    entities: tuple[Any, ...]
    """Its services and its subscription."""


class TurtlesimNode:
    """The node and its turtles. ``arguments``: what follows the program's name, with ``--ros-args``."""

    def __init__(self, graph: Graph, arguments: Sequence[str] = ()) -> None:
        self.node = node = Node(
            "turtlesim", context=context_of(graph), cli_args=list(arguments), use_global_arguments=False
        )
        self._paper = Paper()
        self._inhabitants: dict[str, _Inhabitant] = {}
        self._number = 0
        for letter, name, value in zip("rgb", ("red", "green", "blue"), BACKGROUND, strict=True):
            descriptor = ParameterDescriptor(
                description=f"{name.capitalize()} channel of the background color",
                integer_range=[IntegerRange(from_value=0, to_value=255, step=1)],
            )
            node.declare_parameter(f"background_{letter}", value, descriptor)
        node.declare_parameter(
            "holonomic", False, ParameterDescriptor(description="If true, turtles go sideways")
        )
        node.create_service(Empty, "clear", self._clear)
        node.create_service(Empty, "reset", self._reset)
        node.create_service(Spawn, "spawn", self._spawn)
        node.create_service(Kill, "kill", self._kill)
        node.get_logger().info(f"Starting turtlesim with node name {node.get_fully_qualified_name()}")
        self._paper.clear(self._background)
        self._add_first()
        node.create_timer(PERIOD_S, self._step)

    @property
    def bodies(self) -> tuple[SceneBody, ...]:
        """The turtles, to be drawn."""
        return tuple(_body(each.turtle) for each in list(self._inhabitants.values()))

    @property
    def strokes(self) -> tuple[PenStroke, ...]:
        """The lines that the turtles have drawn."""
        return self._paper.strokes

    @property
    def _background(self) -> Rgb:
        red, green, blue = (self.node.get_parameter(f"background_{letter}").value for letter in "rgb")
        return red, green, blue

    def _step(self) -> None:
        now_ns = self.node.get_clock().now().nanoseconds
        for each in self._inhabitants.values():
            turtle = each.turtle
            each.rotation.step(now_ns)
            turtle.step(PERIOD_S, now_ns)
            pose = turtle.pose
            each.pose_publisher.publish(
                PoseMessage(
                    x=pose.x,
                    y=pose.y,
                    theta=pose.theta,
                    linear_velocity=turtle.speed,
                    angular_velocity=turtle.turn,
                )
            )
            red, green, blue = self._paper.color_at(pose.x, pose.y)
            each.color_publisher.publish(Color(r=red, g=green, b=blue))

    # Turtles

    def _add_first(self) -> None:
        self._add("", Pose(SIDE_M / 2, SIDE_M / 2, 0.0))

    def _add(self, name: str, pose: Pose) -> str:
        """Adds a turtle; returns its name, or nothing if there is one of that name."""
        if name in self._inhabitants:
            self.node.get_logger().error(f"A turtle named [{name}] already exists")
            return ""
        while not name or name in self._inhabitants:
            self._number += 1
            name = f"turtle{self._number}"
        turtle = Turtle(name, pose, self._paper, self.node.get_logger().warning)
        try:
            self._inhabitants[name] = self._make_inhabitant(turtle)
        except InvalidTopicNameException as problem:
            self.node.get_logger().error(str(problem))
            return ""
        self.node.get_logger().info(
            f"Spawning turtle [{name}] at x=[{pose.x:f}], y=[{pose.y:f}], theta=[{pose.theta:f}]"
        )
        return name

    def _make_inhabitant(self, turtle: Turtle) -> _Inhabitant:
        node, name = self.node, turtle.name
        return _Inhabitant(
            turtle,
            pose_publisher=node.create_publisher(PoseMessage, f"{name}/pose", 10),
            color_publisher=node.create_publisher(Color, f"{name}/color_sensor", 10),
            rotation=Rotation(node, turtle),
            entities=(
                node.create_subscription(Twist, f"{name}/cmd_vel", partial(self._command, turtle), 10),
                node.create_service(SetPen, f"{name}/set_pen", partial(_set_pen, turtle)),
                node.create_service(TeleportRelative, f"{name}/teleport_relative", partial(_jump_by, turtle)),
                node.create_service(TeleportAbsolute, f"{name}/teleport_absolute", partial(_jump_to, turtle)),
            ),
        )

    def _remove(self, name: str) -> None:
        gone = self._inhabitants.pop(name)
        gone.rotation.destroy()
        subscription, *services = gone.entities
        self.node.destroy_subscription(subscription)
        for service in services:
            self.node.destroy_service(service)
        for publisher in (gone.pose_publisher, gone.color_publisher):
            self.node.destroy_publisher(publisher)

    def _command(self, turtle: Turtle, message: Twist) -> None:
        values = (message.linear.x, message.linear.y, message.angular.z)
        forward, sideways, turn = values if all(map(math.isfinite, values)) else (0.0, 0.0, 0.0)
        if not self.node.get_parameter("holonomic").value:
            sideways = 0.0
        turtle.command(forward, sideways, turn, self.node.get_clock().now().nanoseconds)

    # Services

    def _clear(self, request: Any, response: Any) -> Any:
        self.node.get_logger().info("Clearing turtlesim.")
        self._paper.clear(self._background)
        return response

    def _reset(self, request: Any, response: Any) -> Any:
        self.node.get_logger().info("Resetting turtlesim.")
        for name in list(self._inhabitants):
            self._remove(name)
        self._number = 0
        self._paper.clear(self._background)
        self._add_first()
        return response

    def _spawn(self, request: Any, response: Any) -> Any:
        response.name = self._add(request.name, Pose(request.x, request.y, request.theta))
        return response

    def _kill(self, request: Any, response: Any) -> Any:
        if request.name in self._inhabitants:
            self._remove(request.name)
        else:
            self.node.get_logger().error(f"Tried to kill turtle [{request.name}], which does not exist")
        return response


def _set_pen(turtle: Turtle, request: Any, response: Any) -> Any:
    color = (request.r, request.g, request.b)
    if request.off:
        turtle.pen = Pen(turtle.pen.color, turtle.pen.width, is_down=False)
    else:
        turtle.pen = Pen(color, request.width or 1)
    return response


def _jump_by(turtle: Turtle, request: Any, response: Any) -> Any:
    turtle.teleport(Teleport(Pose(0.0, 0.0, request.angular), request.linear))
    return response


def _jump_to(turtle: Turtle, request: Any, response: Any) -> Any:
    turtle.teleport(Teleport(Pose(request.x, request.y, request.theta)))
    return response


def _body(turtle: Turtle) -> SceneBody:
    outline = np.array([turtle.pose.transform_point(*point) for point in _SHELL.tolist()])
    return SceneBody(turtle.name, turtle.pose, (outline,), is_robot=True)
