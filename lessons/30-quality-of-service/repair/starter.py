"""A scout that looks for walls, and a driver that hears nothing of it.
Repair it."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Bool


class Scout(Node):
    """The program of a sensor that you bought: leave it as it is."""

    def __init__(self):
        super().__init__("scout")
        profile = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
        self.warn = self.create_publisher(Bool, "wall_ahead", profile)
        self.create_subscription(LaserScan, "static_laser", self.on_scan, 10)

    def on_scan(self, scan):
        near = [distance for distance in scan.ranges[38:53] if distance < 0.5]
        self.warn.publish(Bool(data=bool(near)))


class Driver(Node):
    """Drives ahead, and turns on the spot while a wall is ahead."""

    def __init__(self):
        super().__init__("driver")
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        # TODO: this hears nothing
        self.create_subscription(Bool, "wall_ahead", self.on_wall, 10)

    def on_wall(self, message):
        command = Twist()
        if message.data:
            command.angular.z = 1.0
        else:
            command.linear.x = 0.4
        self.drive.publish(command)


def main(args=None):
    rclpy.init(args=args)
    executor = SingleThreadedExecutor()
    executor.add_node(Scout())
    executor.add_node(Driver())
    executor.spin()


if __name__ == "__main__":
    main()
