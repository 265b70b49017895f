"""Follow a wall at a set distance, on the side that the parameter says.

Save this file and watch the robot: kit drive office --controller (this
file).
"""

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
    """The nearest range [m] of the rays first to last; 10.0 if none of
    them met anything."""
    return min((each for each in ranges[first : last + 1] if math.isfinite(each)), default=10.0)


class Follower(Node):
    def __init__(self):
        super().__init__("follower")
        self.side = self.declare_parameter("side", "right").value
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(LaserScan, "static_laser", self.on_scan, 10)
        self.before = None  # the error at the last scan

    def on_scan(self, scan):
        # reversed, they are those of a mirror
        ranges = list(scan.ranges)
        command = Twist()
        # 1. The wall ahead (rays 40 to 50) within 0.5 m: turn on the
        #    spot, away from the wall that you follow.
        # 2. Else drive at SPEED, and steer by the error and by its
        #    change, within LIMIT.
        # 3. With the wall on the left, all this in a mirror.
        self.drive.publish(command)


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(Follower())


if __name__ == "__main__":
    main()
