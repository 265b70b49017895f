"""The node that the map-based controllers extend: reads the set-up from its parameters, and makes a step whenever
all robots have sent odometry."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

import rclpy
from flatland_msgs.msg import Collisions
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node

from kit.fields.controller_setup import ControllerSetup
from kit.fields.trajectory import VelocityCommand
from kit.geometry import Pose
from kit.world.problems import WorldError

PERIOD_NS = 100_000_000
"""At most ten steps per second, however often odometry arrives."""


class SetupNode(Node):
    """Drives one robot or two along a course. Parameters: ``world`` (a world file), ``models`` (the left one first),
    ``target`` [x, y], ``target_radius`` [m], ``charges`` (a charge file to use instead of the world's). Of several targets
    that is the first; the parameter ``targets``, which has all (``kit.run.episode``), is not used here.

    Stops for good, and says why, when there is no course or a robot has touched something.
    """

    def __init__(self, name: str) -> None:
        super().__init__(name)
        self.setup: ControllerSetup | None = None
        self._poses: dict[str, Pose] = {}
        self._stepped_ns = -PERIOD_NS
        self._drives = {}
        try:
            setup = self._load_setup()
        except (WorldError, LookupError, ValueError, OSError) as error:
            self.get_logger().error(f"Not driving: {error}")
            return
        self.setup = setup
        self._drives = {
            robot.name: self.create_publisher(Twist, robot.commands, 10) for robot in setup.robots
        }
        for robot in setup.robots:
            self.create_subscription(Odometry, robot.odometry, partial(self._on_odometry, robot.name), 10)
            if robot.contacts is not None:
                on_contact = partial(self._on_collisions, robot.name)
                self.create_subscription(Collisions, robot.contacts, on_contact, 10)

    @abstractmethod
    def step(self, setup: ControllerSetup, poses: Sequence[Pose]) -> Sequence[VelocityCommand] | None:
        """Returns the next command of each robot; None to stop for good."""

    def stop(self, reason: str) -> None:
        """Takes its hands off all robots, and says why."""
        if self.setup is not None:
            self.get_logger().warning(reason)
            self.setup = None
        for drive in self._drives.values():
            drive.publish(Twist())

    def _load_setup(self) -> ControllerSetup:
        world = str(self.declare_parameter("world", "").value)
        models = list(self.declare_parameter("models", ["left", "right"]).value)
        target = [float(each) for each in self.declare_parameter("target", [math.nan, math.nan]).value]
        radius = float(self.declare_parameter("target_radius", 0.25).value)
        charges = str(self.declare_parameter("charges", "").value)
        if not world:
            raise ValueError("no world is given: add -p world:=WORLD.yaml.")
        if len(target) != 2 or not all(map(math.isfinite, target)):
            raise ValueError("no target is given: add -p target:=[x, y], or use a map that has one.")
        return ControllerSetup.load(
            Path(world),
            models,
            (target[0], target[1]),
            radius,
            charges=Path(charges) if charges else None,
        )

    def _on_odometry(self, name: str, message: Odometry) -> None:
        if self.setup is None:
            return
        place, turn = message.pose.pose.position, message.pose.pose.orientation
        self._poses[name] = Pose(place.x, place.y, 2.0 * math.atan2(turn.z, turn.w))
        now = message.header.stamp.sec * 1_000_000_000 + message.header.stamp.nanosec
        if len(self._poses) < len(self.setup.robots) or now - self._stepped_ns < PERIOD_NS - 1_000_000:
            return
        self._stepped_ns = now
        commands = self.step(self.setup, [self._poses[robot.name] for robot in self.setup.robots])
        self._poses.clear()
        if commands is None:
            return
        for drive, (forward, turning) in zip(self._drives.values(), commands, strict=True):
            command = Twist()
            command.linear.x, command.angular.z = forward, turning
            drive.publish(command)

    def _on_collisions(self, name: str, message: Collisions) -> None:
        if message.collisions:
            self.stop(f"Stopped: {name} has bumped into something.")


def spin(make_node: Callable[[], Node], args: list[str] | None) -> None:
    rclpy.init(args=args)
    rclpy.spin(make_node())
