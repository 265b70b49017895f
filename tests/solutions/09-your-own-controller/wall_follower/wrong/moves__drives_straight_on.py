"""Follow the wall on the right at a set distance."""

# Lesson: from the wall on its right for four fifths of the time

import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import LaserScan

DISTANCE = 0.35  # m from the middle of the robot to the wall on its right
SPEED = 0.3  # m/s


def nearest(ranges, first, last):
    """The nearest range [m] of the rays first to last, and which ray has it; nan rays met nothing."""
    seen = [(each, ray) for ray, each in enumerate(ranges[first : last + 1], first) if not math.isnan(each)]
    return min(seen, default=(10.0, first))


class WallFollower(Node):
    def __init__(self):
        super().__init__("wall_follower")
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(LaserScan, "static_laser", self.on_scan, 10)

    def on_scan(self, scan):
        ahead, _ = nearest(scan.ranges, 40, 50)
        right, ray = nearest(scan.ranges, 8, 40)
        command = Twist()
        command.linear.x = SPEED
        if True:
            pass
        elif ahead < DISTANCE + 0.1:
            command.angular.z = 1.5  # a corner: turn left on the spot
        elif right > 1.0:
            command.linear.x = SPEED  # no wall in sight yet: go and find one
        else:
            too_near = DISTANCE - right
            askew = math.radians(4 * (ray - 22.5))  # 0 where the robot drives along the wall
            command.linear.x = SPEED
            command.angular.z = max(-1.2, min(1.2, 4.0 * too_near + 1.5 * askew))
        self.drive.publish(command)


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(WallFollower())


if __name__ == "__main__":
    main()
