#!/usr/bin/env python3
import copy
import math

import rclpy
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import LaserScan


class ScanFilter(Node):
    """Keeps the readings between -30 and +30 degrees, everything else becomes inf."""

    def __init__(self):
        super().__init__('scan_filter')
        self.declare_parameter('half_angle', math.radians(30))
        self.half = self.get_parameter('half_angle').value
        self.pub = self.create_publisher(LaserScan, 'scan_filtered', qos_profile_sensor_data)
        self.sub = self.create_subscription(LaserScan, 'scan', self.cb, qos_profile_sensor_data)
        self.n = 0

    def cb(self, msg: LaserScan):
        out = copy.deepcopy(msg)
        kept = []
        new = [float('inf')] * len(msg.ranges)
        for i, r in enumerate(msg.ranges):
            a = math.remainder(msg.angle_min + i * msg.angle_increment, 2 * math.pi)
            if abs(a) <= self.half:
                new[i] = r
                kept.append(r)
        out.ranges = new
        self.pub.publish(out)
        self.n += 1
        if self.n == 20:
            width = len(kept) / len(msg.ranges)
            self.get_logger().info('kept %.0f%% of the beams, nearest %.2f' % (100 * width, min(kept)))


def main(args=None):
    rclpy.init(args=args)
    n = ScanFilter()
    rclpy.spin(n)


if __name__ == '__main__':
    main()
