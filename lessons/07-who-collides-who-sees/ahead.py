"""Drives straight ahead, whatever comes."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class Ahead(Node):
    def __init__(self) -> None:
        super().__init__("ahead")
        self.wheels = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_timer(0.1, self.go)

    def go(self) -> None:
        command = Twist()
        command.linear.x = 0.5
        self.wheels.publish(command)


def main(args: list[str] | None = None) -> None:
    rclpy.init(args=args)
    rclpy.spin(Ahead())
