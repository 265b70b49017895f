#!/usr/bin/env python3
import math

import message_filters
import rclpy
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from sensor_msgs.msg import LaserScan


class Fusion(Node):
    """odometry x + front distance must always be the same number: where the wall is"""

    def __init__(self):
        super().__init__('fusion')
        self.scan_sub = message_filters.Subscriber(self, LaserScan, 'scan', qos_profile=qos_profile_sensor_data)
        self.odom_sub = message_filters.Subscriber(self, Odometry, 'odom')
        self.ts = message_filters.ApproximateTimeSynchronizer([self.scan_sub, self.odom_sub], 30, 0.1)
        self.ts.registerCallback(self.both)
        self.pub = self.create_publisher(Twist, 'cmd_vel', 10)
        self.timer = self.create_timer(0.1, self.move)
        self.walls = []

    def both(self, scan, odom):
        i = round(-scan.angle_min / scan.angle_increment) % len(scan.ranges)
        d = scan.ranges[i]
        if math.isfinite(d):
            self.walls.append(odom.pose.pose.position.x + d)
            if len(self.walls) == 30:
                spread = max(self.walls) - min(self.walls)
                mean = sum(self.walls) / len(self.walls)
                ok = 'consistent' if spread < 0.3 else 'NOT consistent'
                self.get_logger().info(f'wall at x = {mean:.1f}, measurements are {ok}')

    def move(self):
        t = Twist()
        if len(self.walls) < 30:
            t.linear.x = 0.3
        self.pub.publish(t)


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(Fusion())


main()
