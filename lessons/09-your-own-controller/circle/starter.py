"""A robot that moves in a circle. Change it, so that the circle has a
radius of 0.3 m."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import LaserScan


class Circle(Node):
    def __init__(self) -> None:
        super().__init__("circle")
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(LaserScan, "static_laser", self.on_scan, 10)

    def on_scan(self, scan: LaserScan) -> None:
        command = Twist()
        command.linear.x = 0.4  # m/s
        command.angular.z = 1.0  # rad/s, to the left
        self.drive.publish(command)


def main(args: list[str] | None = None) -> None:
    rclpy.init(args=args)
    rclpy.spin(Circle())


if __name__ == "__main__":
    main()
