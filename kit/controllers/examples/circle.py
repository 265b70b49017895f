"""Example 2: a robot that moves in a circle."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import LaserScan


class CircleDriver(Node):
    def __init__(self) -> None:
        super().__init__("circle")
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(LaserScan, "static_laser", self.on_scan, 10)

    def on_scan(self, scan: LaserScan) -> None:
        command = Twist()
        command.linear.x = 0.4  # m/s
        command.angular.z = 1.0  # rad/s: the circle's radius is 0.4 / 1.0 m
        self.drive.publish(command)


def main(args: list[str] | None = None) -> None:
    rclpy.init(args=args)
    rclpy.spin(CircleDriver())


if __name__ == "__main__":
    main()
