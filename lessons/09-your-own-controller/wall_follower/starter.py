"""Follow the wall on the right at a set distance.

Save this file and watch the robot: kit drive house --controller (this
file).
"""

import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import LaserScan

# m from the middle of the robot to the wall on its right
DISTANCE = 0.35
SPEED = 0.3  # m/s


def nearest(ranges, first, last):
    """The nearest range [m] of the rays first to last, and which ray has
    it; nan rays met nothing."""
    seen = [(each, ray) for ray, each in enumerate(ranges[first : last + 1], first) if not math.isnan(each)]
    return min(seen, default=(10.0, first))


class WallFollower(Node):
    def __init__(self):
        super().__init__("wall_follower")
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(LaserScan, "static_laser", self.on_scan, 10)

    def on_scan(self, scan):
        ahead, _ = nearest(scan.ranges, 40, 50)
        # ray 22 or 23 points straight to the right
        right, ray = nearest(scan.ranges, 8, 40)
        command = Twist()
        # 1. Before a corner (ahead is small): turn left on the spot,
        #    command.angular.z = 1.5
        # 2. No wall within a metre on the right: go and find one,
        #    command.linear.x = SPEED
        # 3. Else go, and steer by how much too near the wall is, and by
        #    how askew the robot stands.
        self.drive.publish(command)


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(WallFollower())


if __name__ == "__main__":
    main()
