#!/usr/bin/env python3
# LaserScan -> PointCloud2, five clouds, then the program ends by itself
import math
import rclpy
from rclpy.node import Node
from rclpy.task import Future
from sensor_msgs.msg import LaserScan, PointCloud2, PointField
from sensor_msgs_py import point_cloud2
from std_msgs.msg import Header


class ScanToCloud(Node):
    def __init__(self):
        super().__init__('scan_to_cloud')
        self.done = Future()
        self.n = 0
        self.pub = self.create_publisher(PointCloud2, 'cloud', 5)
        self.sub = self.create_subscription(LaserScan, 'scan', self.convert, 5)

    def convert(self, scan: LaserScan) -> None:
        points = []
        for i, r in enumerate(scan.ranges):
            if math.isfinite(r) and scan.range_min <= r <= scan.range_max:
                a = scan.angle_min + i * scan.angle_increment
                points.append((r * math.cos(a), r * math.sin(a), 0.0, float(i)))
        fields = [PointField(name=n, offset=4 * k, datatype=PointField.FLOAT32, count=1)
                  for k, n in enumerate(('x', 'y', 'z', 'intensity'))]
        header = Header(stamp=scan.header.stamp, frame_id=scan.header.frame_id)
        self.pub.publish(point_cloud2.create_cloud(header, fields, points))
        self.n += 1
        if self.n == 5 and not self.done.done():
            self.done.set_result(len(points))


def main():
    rclpy.init()
    node = ScanToCloud()
    rclpy.spin_until_future_complete(node, node.done, timeout_sec=10.0)
    print('clouds of', node.done.result(), 'points')
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
