"""Looks at one ray on the right, and steers by its error and its change, without a limit."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import LaserScan


class OneRay(Node):
    def __init__(self):
        super().__init__("one_ray")
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(LaserScan, "static_laser", self.on_scan, 10)
        self.before = None

    def on_scan(self, scan):
        error = 0.4 - scan.ranges[22]  # straight to the right
        change = 0.0 if self.before is None else (error - self.before) / 0.1
        self.before = error
        command = Twist()
        command.linear.x, command.angular.z = 0.3, 2.0 * error + 3.0 * change
        self.drive.publish(command)


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(OneRay())
