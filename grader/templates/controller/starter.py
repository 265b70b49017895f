"""Round the corner: drive to the target and touch nothing."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import LaserScan


class Corner(Node):
    def __init__(self) -> None:
        super().__init__("corner")
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(LaserScan, "static_laser", self.on_scan, 10)

    def on_scan(self, scan: LaserScan) -> None:
        """Called ten times a second. scan.ranges[45] is the distance straight ahead [m], [68] to the left."""
        self.drive.publish(Twist())


def main(args: list[str] | None = None) -> None:
    rclpy.init(args=args)
    rclpy.spin(Corner())


if __name__ == "__main__":
    main()
