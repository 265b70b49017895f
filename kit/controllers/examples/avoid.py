"""Example 3: a robot that moves forward and turns right when something is in front of it."""

import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import LaserScan


class Avoid(Node):
    def __init__(self) -> None:
        super().__init__("avoid")
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(LaserScan, "static_laser", self.on_scan, 10)

    def on_scan(self, scan: LaserScan) -> None:
        ahead = scan.ranges[len(scan.ranges) // 2]
        command = Twist()
        if math.isnan(ahead) or ahead < 1.0:  # nan: the ray met nothing within range
            command.angular.z = -2.0  # rad/s, clockwise
        else:
            command.linear.x = 1.0  # m/s
        self.drive.publish(command)


def main(args: list[str] | None = None) -> None:
    rclpy.init(args=args)
    rclpy.spin(Avoid())


if __name__ == "__main__":
    main()
