"""Keep going, and touch nothing: turn to the side with more room."""

# Lesson: leaves out `nan`, a ray that met nothing

import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import LaserScan

ROOM = 0.35  # m that must be free ahead


def nearest(ranges):
    """The nearest range [m]; nan rays met nothing."""
    return min((0.0 if math.isnan(each) else each for each in ranges), default=10.0)


class Wanderer(Node):
    def __init__(self):
        super().__init__("wanderer")
        self.turning = 0.0  # rad/s while it turns away from something; else 0
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(LaserScan, "static_laser", self.on_scan, 10)

    def on_scan(self, scan):
        command = Twist()
        ahead, right, left = (nearest(scan.ranges[k : k + 15]) for k in (38, 23, 53))
        if ahead >= ROOM:
            self.turning = 0.0
            command.linear.x = 0.3
        else:
            if self.turning == 0.0:  # choose a side once, and stay with it: else it would shake its head for ever
                self.turning = 1.5 if left > right else -1.5
            command.angular.z = self.turning
        self.drive.publish(command)


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(Wanderer())


if __name__ == "__main__":
    main()
