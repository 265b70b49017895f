"""Drive ahead, with care: 0.6 m/s; half of it with a wall within 1.2 m
ahead; stop when it is within 0.5 m."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import LaserScan


class Cautious(Node):
    def __init__(self):
        super().__init__("cautious")
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(LaserScan, "static_laser", self.on_scan, 10)

    def on_scan(self, scan):
        """Called with every message of the laser. scan.ranges[45] is the
        distance straight ahead, in metres."""
        command = Twist()
        # TODO: 0.6, or 0.3, or 0.0, as scan.ranges[45] says
        command.linear.x = 0.0
        self.drive.publish(command)


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(Cautious())


if __name__ == "__main__":
    main()
