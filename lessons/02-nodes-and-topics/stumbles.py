"""Drives ahead, and stumbles over its own mistake after three seconds. For the lesson on nodes and topics."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class Stumbles(Node):
    def __init__(self) -> None:
        super().__init__("stumbles")
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        self.steps = 30
        self.create_timer(0.1, self.step)

    def step(self) -> None:
        self.steps -= 1
        command = Twist()
        command.linear.x = 0.5 + 0.0 / self.steps  # after thirty steps: a division by zero
        self.drive.publish(command)


def main(args: list[str] | None = None) -> None:
    rclpy.init(args=args)
    rclpy.spin(Stumbles())


if __name__ == "__main__":
    main()
