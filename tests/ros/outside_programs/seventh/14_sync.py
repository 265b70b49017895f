import math
import sys

import message_filters
import rclpy
from geometry_msgs.msg import PointStamped
from nav_msgs.msg import Odometry
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import LaserScan, Range


class Merge(Node):
    """Nearest obstacle in the frame of odom, from a scan and the odometry that belongs to it."""

    def __init__(self):
        super().__init__('merge')
        self.n = 0
        self.worst = 0.0
        self.scan = message_filters.Subscriber(self, LaserScan, 'scan', qos_profile=qos_profile_sensor_data)
        self.odom = message_filters.Subscriber(self, Odometry, 'odom')
        self.cache = message_filters.Cache(self.odom, 50)
        self.sync = message_filters.ApproximateTimeSynchronizer([self.scan, self.odom], queue_size=20, slop=0.1)
        self.sync.registerCallback(self.both, 'context')
        self.pub = self.create_publisher(PointStamped, 'nearest', 10)
        # two exact streams of our own
        self.a = self.create_publisher(Range, 'a', 10)
        self.b = self.create_publisher(Range, 'b', 10)
        self.pairs = []
        exact = message_filters.TimeSynchronizer([message_filters.Subscriber(self, Range, t) for t in ('a', 'b')], 10)
        exact.registerCallback(lambda x, y: self.pairs.append((x.range, y.range)))
        self.exact = exact
        self.k = 0
        self.create_timer(0.2, self.emit)
        self.create_timer(5.0, self.tell)

    def emit(self):
        stamp = self.get_clock().now().to_msg()
        r = Range(range=float(self.k))
        r.header.stamp = stamp
        self.a.publish(r)
        if self.k % 2 == 0:
            r2 = Range(range=float(self.k) + 0.5)
            r2.header.stamp = stamp
            self.b.publish(r2)
        self.k += 1

    def both(self, scan, odom, context):
        assert context == 'context'
        t = [m.header.stamp.sec + m.header.stamp.nanosec * 1e-9 for m in (scan, odom)]
        self.worst = max(self.worst, abs(t[0] - t[1]))
        self.n += 1
        i = min(range(len(scan.ranges)), key=lambda i: scan.ranges[i] if scan.ranges[i] > scan.range_min else math.inf)
        q = odom.pose.pose.orientation
        yaw = 2 * math.atan2(q.z, q.w) + scan.angle_min + i * scan.angle_increment
        out = PointStamped(header=odom.header)
        out.point.x = odom.pose.pose.position.x + scan.ranges[i] * math.cos(yaw)
        out.point.y = odom.pose.pose.position.y + scan.ranges[i] * math.sin(yaw)
        self.pub.publish(out)

    def tell(self):
        self.get_logger().info(f'merged {"many" if self.n >= 20 else self.n}, within the slop: {self.worst <= 0.1}')
        self.get_logger().info(f'pairs {self.pairs[:4]}')
        latest = self.cache.getLast()
        before = self.cache.getElemBeforeTime(self.get_clock().now())
        self.get_logger().info(f'cache {latest is not None and latest.header.stamp == before.header.stamp}')
        sys.exit()


def main():
    rclpy.init()
    rclpy.spin(Merge())


if __name__ == '__main__':
    main()
