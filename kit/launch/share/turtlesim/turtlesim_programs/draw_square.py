"""Resets turtlesim and lets ``turtle1`` draw squares of 2 m for ever."""

import math
from typing import Any

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from std_srvs.srv import Empty
from turtlesim.msg import Pose

SIDE_M = 2.0


class DrawSquareNode(Node):
    """Drives a side, stops, turns by a quarter, stops, and so on."""

    def __init__(self) -> None:
        super().__init__("draw_square")
        self.pose: Any = None
        self.goal: Any = None
        self.is_turning = False
        self.is_stopping = False
        self.publisher = self.create_publisher(Twist, "turtle1/cmd_vel", 1)
        self.create_subscription(Pose, "turtle1/pose", self.on_pose, 1)
        self.resetting = self.create_client(Empty, "reset")
        self.has_reset = False
        self.create_timer(0.016, self.step)

    def on_pose(self, pose: Pose) -> None:
        self.pose = pose

    def step(self) -> None:
        if not self.has_reset:
            if self.resetting.service_is_ready():
                self.resetting.call_async(Empty.Request())
                self.has_reset = True
            return
        if self.pose is None:
            return
        if self.goal is None:
            self.goal = self.next_goal()
        x, y, theta = self.goal
        if self.is_stopping:
            self.drive(0.0, 0.0)
            if self.pose.linear_velocity == 0.0 and self.pose.angular_velocity == 0.0:
                self.is_stopping, self.is_turning = False, not self.is_turning
                self.goal = self.next_goal()
        elif self.is_turning:
            left = math.remainder(theta - self.pose.theta, 2 * math.pi)
            self.is_stopping = left < 0.01  # or past it
            self.drive(0.0, min(0.4, max(0.05, 2 * left)))
        else:
            ahead = math.cos(theta) * (x - self.pose.x) + math.sin(theta) * (y - self.pose.y)
            self.is_stopping = ahead < 0.02  # or past it
            self.drive(min(1.0, max(0.1, 2 * ahead)), 0.0)

    def next_goal(self) -> tuple[float, float, float]:
        """Where the next side ends, or the heading after the next turn."""
        x, y, theta = self.pose.x, self.pose.y, self.pose.theta
        if self.is_turning:
            return x, y, theta + math.pi / 2
        return x + math.cos(theta) * SIDE_M, y + math.sin(theta) * SIDE_M, theta

    def drive(self, linear: float, angular: float) -> None:
        command = Twist()
        command.linear.x, command.angular.z = linear, angular
        self.publisher.publish(command)


def main() -> None:
    rclpy.init()
    rclpy.spin(DrawSquareNode())
