"""turtlesim's node: its turtles, what they draw, and its services, topics, actions and parameters, in any graph.

The field is 11.0889 m wide and high; ``turtle1`` starts in its middle. Turtles draw on an image of 500 by 500 dots, as
turtlesim's window has, and the same as strokes that the world view shows. The picture's background is the terminal's
own: the parameters ``background_r``, ``background_g`` and ``background_b`` say what ``color_sensor`` reports where
nothing is drawn, from the next ``clear`` or ``reset`` on. The programs beside it are in ``share/turtlesim``.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, Final

import numpy as np

from kit.geometry import Pose
from kit.launch.turtlesim.paper import BACKGROUND, SIDE_M, Paper, Pen, Rgb
from kit.launch.turtlesim.turtle import Rotation, Teleport, Turtle
from kit.msg.geometry_msgs import Twist
from kit.msg.rcl_interfaces import IntegerRange, ParameterDescriptor
from kit.msg.std_srvs import Empty
from kit.msg.turtlesim import Color, Kill, SetPen, Spawn, TeleportAbsolute, TeleportRelative
from kit.msg.turtlesim import Pose as PoseMessage
from kit.render.scene import PenStroke, SceneBody
from kit.ros.exceptions import InvalidTopicNameException
from kit.ros.execution.context import context_of
from kit.ros.graph.graph import Graph
from kit.ros.node.node import Node

PERIOD_S: Final = 0.016
"""turtlesim moves its turtles and reports their poses at this interval [s]."""
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
