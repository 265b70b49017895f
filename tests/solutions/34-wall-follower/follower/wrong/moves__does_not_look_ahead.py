"""Follow a wall at a set distance, on the side that the parameter says."""

# Lesson: No ray on the side sees it. So look ahead as well

import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import LaserScan

DISTANCE = 0.4  # m from the laser to the wall
SPEED = 0.3  # m/s
LIMIT = 1.2  # rad/s
SECONDS = 0.1  # from one scan to the next


def nearest(ranges, first, last):
    """The nearest range [m] of the rays first to last; 10.0 if none of them met anything."""
    return min((each for each in ranges[first : last + 1] if math.isfinite(each)), default=10.0)


class Follower(Node):
    def __init__(self):
        super().__init__("follower")
        self.side = self.declare_parameter("side", "right").value
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(LaserScan, "static_laser", self.on_scan, 10)
        self.before = None  # the error at the last scan

    def on_scan(self, scan):
        ranges = list(scan.ranges)
        if self.side == "left":
            ranges.reverse()  # in a mirror the wall is on the right
        command = Twist()
        error = DISTANCE - nearest(ranges, 8, 36)
        change = 0.0 if self.before is None else (error - self.before) / SECONDS
        self.before = error
        if False:
            command.angular.z = LIMIT  # a corner: turn away from the wall, on the spot
        else:
            command.linear.x = SPEED
            command.angular.z = max(-LIMIT, min(LIMIT, 4.0 * error + 4.0 * change))
        if self.side == "left":
            command.angular.z = -command.angular.z
        self.drive.publish(command)


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(Follower())


if __name__ == "__main__":
    main()
