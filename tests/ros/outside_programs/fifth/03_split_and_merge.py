#!/usr/bin/env python3
import math

import numpy as np
import rclpy
from geometry_msgs.msg import Point
from rclpy.duration import Duration
from rclpy.node import Node
from sensor_msgs.msg import LaserScan
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import Marker, MarkerArray


def split(points, limit=0.05):
    """Recursive split of ordered points into segments."""
    if len(points) < 5:
        return []
    a, b = points[0], points[-1]
    d = b - a
    n = np.array([-d[1], d[0]]) / (np.linalg.norm(d) + 1e-9)
    far = np.abs((points - a) @ n)
    i = int(np.argmax(far))
    if far[i] > limit:
        return split(points[:i + 1], limit) + split(points[i:], limit)
    return [(a, b)]


class Extractor(Node):

    def __init__(self):
        super().__init__('line_extractor')
        self.pub = self.create_publisher(MarkerArray, '~/lines', 1)
        self.count = 0
        self.create_subscription(LaserScan, '/scan', self.cb, rclpy.qos.QoSPresetProfiles.SENSOR_DATA.value)

    def cb(self, scan: LaserScan):
        ranges = np.array(scan.ranges, dtype=float)
        angles = np.linspace(scan.angle_min, scan.angle_max, len(ranges))
        good = np.isfinite(ranges)
        pts = np.c_[ranges * np.cos(angles), ranges * np.sin(angles)][good]
        lines = split(pts)
        long = [(a, b) for a, b in lines if np.linalg.norm(b - a) > 1.0]
        array = MarkerArray()
        array.markers.append(Marker(action=Marker.DELETEALL))
        m = Marker()
        m.header = scan.header
        m.ns, m.id, m.type, m.action = 'lines', 1, Marker.LINE_LIST, Marker.ADD
        m.scale.x = 0.03
        m.color = ColorRGBA(r=1.0, a=1.0)
        m.pose.orientation.w = 1.0
        m.lifetime = Duration(seconds=0.5).to_msg()
        for a, b in long:
            m.points += [Point(x=float(a[0]), y=float(a[1])), Point(x=float(b[0]), y=float(b[1]))]
        array.markers.append(m)
        self.pub.publish(array)
        self.count += 1
        if self.count == 10:
            away = sorted(abs(a[0] * (b - a)[1] - a[1] * (b - a)[0]) / math.hypot(*(b - a)) for a, b in long)
            self.get_logger().info(f'{len(long)} lines, nearest {away[0]:.1f} m, markers in {m.header.frame_id}')
            raise SystemExit


def main(args=None):
    rclpy.init(args=args)
    node = Extractor()
    try:
        rclpy.spin(node)
    except SystemExit:
        rclpy.logging.get_logger('quitting').info('bye')
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
