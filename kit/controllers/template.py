"""My controller.

Save this file and the robot does what it says. It is an ordinary ROS 2
node: the same file drives a real robot. Three worked examples stand beside
the kit's own controllers: forward, circle, avoid.
"""

import rclpy
from flatland_msgs.msg import Collisions
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import LaserScan


class MyController(Node):
    def __init__(self) -> None:
        super().__init__("my_controller")
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(LaserScan, "static_laser", self.on_scan, 10)
        self.create_subscription(Collisions, "collisions", self.on_collisions, 10)

    def on_scan(self, scan: LaserScan) -> None:
        """Called ten times a second with what the laser sees.

        scan.ranges holds 91 distances [m], one every 4 degrees, from straight
        back counter-clockwise: scan.ranges[45] looks straight ahead, [22] to
        the right, [68] to the left. nan: nothing within range.
        """
        command = Twist()
        # command.linear.x = 0.5   # forward [m/s]
        # command.angular.z = 1.0  # to the left [rad/s]
        self.drive.publish(command)

    def on_collisions(self, message: Collisions) -> None:
        """Called when something touches the robot; message.collisions: what."""


def main(args: list[str] | None = None) -> None:
    rclpy.init(args=args)
    rclpy.spin(MyController())


if __name__ == "__main__":
    main()
