"""Example 1: a robot that moves forward."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import LaserScan


class Forward(Node):
    def __init__(self) -> None:
        super().__init__("forward")
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(LaserScan, "static_laser", self.on_scan, 10)

    def on_scan(self, scan: LaserScan) -> None:
        command = Twist()
        command.linear.x = 1.0  # m/s
        self.drive.publish(command)


def main(args: list[str] | None = None) -> None:
    rclpy.init(args=args)
    rclpy.spin(Forward())


if __name__ == "__main__":
    main()
