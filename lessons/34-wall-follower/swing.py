"""Turns in proportion to the error, and does nothing else."""

import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import LaserScan


class Swing(Node):
    def __init__(self):
        super().__init__("swing")
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(LaserScan, "static_laser", self.on_scan, 10)

    def on_scan(self, scan):
        distance = min(each for each in scan.ranges[8:37] if math.isfinite(each))  # rays on the right
        error = 0.4 - distance
        command = Twist()
        command.linear.x, command.angular.z = 0.3, 2.0 * error
        self.drive.publish(command)


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(Swing())
