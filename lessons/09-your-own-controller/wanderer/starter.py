"""Keep going, and touch nothing.

Save this file and watch the robot: kit drive maze --controller (this
file).
"""

import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import LaserScan


def nearest(ranges):
    """The nearest range [m]; nan rays met nothing."""
    return min((each for each in ranges if not math.isnan(each)), default=10.0)


class Wanderer(Node):
    def __init__(self):
        super().__init__("wanderer")
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(LaserScan, "static_laser", self.on_scan, 10)

    def on_scan(self, scan):
        """Ten times a second: 91 ranges, ranges[45] straight ahead, [22]
        to the right, [68] to the left."""
        command = Twist()
        ahead = nearest(scan.ranges[38:53])
        # 1. If there is room ahead, drive: command.linear.x = 0.3
        # 2. Else turn, to the side with more room:
        #    command.angular.z = 1.5 or -1.5
        # 3. Which side? Choose once for each wall, and remember the
        #    side in self.
        self.drive.publish(command)


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(Wanderer())


if __name__ == "__main__":
    main()
