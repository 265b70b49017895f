"""A tidy laser program, as a student would write it after the lessons: to the target, along the freest beam that leads there.

It has the laser and the odometry, no map and no plan. At tag the target is the other robot, or the way from it.
"""

from __future__ import annotations

import math

import numpy as np
import rclpy
from geometry_msgs.msg import PoseStamped, Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Bool

SPEED = 0.5
"""At most [m/s]."""
TURN_RATE = 1.5
"""[rad/s]"""
HALF_WIDTH = 0.14
"""Of the robot, and something to spare [m]."""
LOOK = 0.9
"""Farther obstacles do not matter [m]."""
NEAR = 0.2
"""A target that is so near has been reached [m]."""


class LaserProgram(Node):
    def __init__(self) -> None:
        super().__init__("laser_program")
        for name, value in (("target", [0.0, 0.0]), ("targets", [0.0])):
            self.declare_parameter(name, value)
        targets = list(self.get_parameter("targets").value)
        if len(targets) < 2:
            targets = list(self.get_parameter("target").value)
        self.targets = list(zip(targets[::2], targets[1::2], strict=True))
        self.pose: tuple[float, float, float] | None = None
        self.scan: LaserScan | None = None
        self.is_catcher = False
        self.other: tuple[float, float] | None = None  # nobody in a race
        self.publisher = self.create_publisher(Twist, "cmd_vel", 1)
        self.create_subscription(Odometry, "odom", self.hear, 1)
        self.create_subscription(LaserScan, "static_laser", self.see, 1)
        self.create_subscription(Bool, "is_catcher", self.be_told, 1)
        self.create_subscription(PoseStamped, "goal_pose", self.meet, 1)
        self.create_timer(0.05, self.drive)

    def hear(self, message: Odometry) -> None:
        place, turn = message.pose.pose.position, message.pose.pose.orientation
        self.pose = place.x, place.y, 2.0 * math.atan2(turn.z, turn.w)

    def see(self, message: LaserScan) -> None:
        self.scan = message

    def be_told(self, message: Bool) -> None:
        self.is_catcher = message.data

    def meet(self, message: PoseStamped) -> None:
        self.other = message.pose.position.x, message.pose.position.y

    def drive(self) -> None:
        if self.pose is None or self.scan is None or not self.targets:
            return
        x, y, theta = self.pose
        to_x, to_y = self.other or self.targets[0]
        distance = math.hypot(to_x - x, to_y - y)
        if self.other is None and distance < NEAR and len(self.targets) > 1:
            self.targets.pop(0)
            return
        wanted = math.remainder(math.atan2(to_y - y, to_x - x) - theta, math.tau)
        if self.other is not None and not self.is_catcher:
            wanted, distance = math.remainder(wanted + math.pi, math.tau), LOOK
        heading, free = self.freest(self.scan, wanted, min(distance, LOOK))
        command = Twist()
        command.angular.z = max(-TURN_RATE, min(TURN_RATE, 4.0 * heading))
        slow = max(0.0, math.cos(1.3 * heading))
        command.linear.x = SPEED * slow * min(1.0, free / 0.3)
        self.publisher.publish(command)

    def freest(self, scan: LaserScan, wanted: float, look: float) -> tuple[float, float]:
        """The heading nearest to the wanted one in which the robot has room, and how much it has."""
        ranges = np.asarray(scan.ranges)
        angles = scan.angle_min + scan.angle_increment * np.arange(len(ranges))
        seen = (scan.range_min <= ranges) & (ranges <= scan.range_max)
        x, y = ranges[seen] * np.cos(angles[seen]), ranges[seen] * np.sin(angles[seen])
        headings = np.radians(np.arange(-110.0, 111.0, 5.0))
        if abs(wanted) <= math.radians(110):
            headings = np.append(headings, wanted)
        cosine, sine = np.cos(headings)[:, None], np.sin(headings)[:, None]
        along, across = x * cosine + y * sine, y * cosine - x * sine
        is_in_the_way = (along > 0.0) & (np.abs(across) < HALF_WIDTH)
        room = np.min(np.where(is_in_the_way, along, look), axis=1, initial=look)
        away = np.abs((headings - wanted + math.pi) % math.tau - math.pi)
        best = np.argmin(away + 0.2 * np.abs(headings) + 3.0 * (look - room))
        return float(headings[best]), max(0.0, float(room[best]) - 0.1)


def main() -> None:
    rclpy.init()
    rclpy.spin(LaserProgram())


if __name__ == "__main__":
    main()
