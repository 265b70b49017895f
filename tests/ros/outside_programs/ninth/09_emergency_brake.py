"""Automatic emergency braking by the time to collision, between a reckless driver and the base."""

import math

import numpy as np
import rclpy
from ackermann_msgs.msg import AckermannDriveStamped
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Bool


class RecklessDriver(Node):
    def __init__(self):
        super().__init__("reckless")
        self.pub = self.create_publisher(AckermannDriveStamped, "/teleop", 10)
        self.create_timer(0.05, self.drive)

    def drive(self):
        msg = AckermannDriveStamped()
        msg.header.stamp = self.get_clock().now().to_msg()
        msg.header.frame_id = "base_link"
        msg.drive.speed = 0.8
        msg.drive.steering_angle = 0.0
        self.pub.publish(msg)


class Safety(Node):
    def __init__(self):
        super().__init__("safety_node")
        self.declare_parameter("ttc", 1.2)
        self.speed = 0.0
        self.braking = False
        self.drive_pub = self.create_publisher(AckermannDriveStamped, "/drive", 10)
        self.brake_pub = self.create_publisher(Bool, "/brake_bool", 10)
        self.create_subscription(Odometry, "/odom", self.odom_callback, 10)
        self.create_subscription(LaserScan, "/scan", self.scan_callback, 10)
        self.create_subscription(AckermannDriveStamped, "/teleop", self.teleop_callback, 10)

    def odom_callback(self, odom):
        self.speed = odom.twist.twist.linear.x

    def teleop_callback(self, msg):
        if not self.braking:
            self.drive_pub.publish(msg)

    def scan_callback(self, scan):
        ranges = np.asarray(scan.ranges, dtype=np.float64)
        angles = scan.angle_min + np.arange(ranges.size) * scan.angle_increment
        closing = np.maximum(self.speed * np.cos(angles), 0.0)
        with np.errstate(divide="ignore", invalid="ignore"):
            ttc = np.where(closing > 0, ranges / closing, np.inf)
        ttc = ttc[np.isfinite(ttc)]
        if ttc.size and ttc.min() < self.get_parameter("ttc").value and not self.braking:
            self.braking = True
            nearest = np.nanmin(ranges)
            self.get_logger().warning(f"brake: {ttc.min():.2f} s left, {nearest:.2f} m")
        if self.braking:
            stop = AckermannDriveStamped()
            stop.header = scan.header
            stop.drive.speed = 0.0
            self.drive_pub.publish(stop)
        self.brake_pub.publish(Bool(data=self.braking))


class Converter(Node):
    """Drives a base that takes a Twist."""

    WHEELBASE = 0.33

    def __init__(self):
        super().__init__("converter")
        self.pub = self.create_publisher(Twist, "/cmd_vel", 10)
        self.create_subscription(AckermannDriveStamped, "/drive", self.convert, 10)

    def convert(self, msg):
        twist = Twist()
        twist.linear.x = msg.drive.speed
        twist.angular.z = msg.drive.speed * math.tan(msg.drive.steering_angle) / self.WHEELBASE
        self.pub.publish(twist)


def main(args=None):
    rclpy.init(args=args)
    nodes = [RecklessDriver(), Safety(), Converter()]
    executor = rclpy.executors.SingleThreadedExecutor()
    for node in nodes:
        executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, rclpy.executors.ExternalShutdownException):
        pass
    for node in nodes:
        node.destroy_node()
    rclpy.try_shutdown()


if __name__ == "__main__":
    main()
