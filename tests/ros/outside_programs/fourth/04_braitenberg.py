import math

import numpy as np
import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import LaserScan


class Vehicle(Node):
    """Braitenberg vehicle 3b: crossed, inhibiting connections; it explores and never touches."""

    def __init__(self):
        super().__init__("braitenberg")
        self.sub = self.create_subscription(LaserScan, "/scan", self.sense, qos_profile_sensor_data)
        self.pub = self.create_publisher(Twist, "/cmd_vel", 1)
        self.closest = math.inf
        self.create_timer(5.0, self.report)

    def sense(self, scan: LaserScan):
        ranges = np.array(scan.ranges)
        angles = scan.angle_min + np.arange(len(ranges)) * scan.angle_increment
        angles = np.arctan2(np.sin(angles), np.cos(angles))
        ranges = np.where(np.isfinite(ranges), ranges, scan.range_max)
        self.closest = min(self.closest, float(ranges.min()))
        left = ranges[(angles > 0.1) & (angles < 1.2)].min()
        right = ranges[(angles < -0.1) & (angles > -1.2)].min()
        light_left, light_right = 1.0 / left, 1.0 / right
        wheel_left = 0.4 - 0.25 * light_right
        wheel_right = 0.4 - 0.25 * light_left
        if min(left, right) < 0.7:
            wheel_left, wheel_right = -0.1, 0.1
        cmd = Twist()
        cmd.linear.x = float(wheel_left + wheel_right) / 2
        cmd.angular.z = float(wheel_right - wheel_left) / 0.3
        self.pub.publish(cmd)

    def report(self):
        self.get_logger().info("never closer than %.1f m" % self.closest)


def main():
    rclpy.init()
    vehicle = Vehicle()
    try:
        rclpy.spin(vehicle)
    except KeyboardInterrupt:
        pass


if __name__ == "__main__":
    main()
