"""Drives ahead until something is near."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from scout_tools.limits import limited
from sensor_msgs.msg import LaserScan


class Drive(Node):
    def __init__(self):
        super().__init__("drive")
        self.speed = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(LaserScan, "static_laser", self.look, 10)

    def look(self, scan):
        command = Twist()
        command.linear.x = limited(min(scan.ranges) - 0.3)
        self.speed.publish(command)


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(Drive())
