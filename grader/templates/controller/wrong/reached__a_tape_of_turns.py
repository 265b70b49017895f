"""Drives by the clock alone: it never asks the laser."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class Tape(Node):
    def __init__(self) -> None:
        super().__init__("tape")
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_timer(0.1, self.on_timer)
        self.count = 0

    def on_timer(self) -> None:
        command = Twist()
        is_corner = 34 <= self.count < 44
        command.linear.x = 0.32 if is_corner else 0.4
        command.angular.z = -1.57 if is_corner else 0.0
        self.count += 1
        self.drive.publish(command)


def main(args: list[str] | None = None) -> None:
    rclpy.init(args=args)
    rclpy.spin(Tape())


if __name__ == "__main__":
    main()
