import math

import numpy as np
import rclpy
from geometry_msgs.msg import TwistStamped, Point
from rclpy.node import Node
from rclpy.qos import QoSPresetProfiles
from sensor_msgs.msg import LaserScan
from visualization_msgs.msg import Marker


class WallFollower(Node):
    """Keeps `distance` to the wall on the right; the line is found by RANSAC; a PD controller steers."""

    def __init__(self):
        super().__init__('wall_follower')
        self.declare_parameter('distance', 0.5)
        self.declare_parameter('velocity', 0.15)
        self.rng = np.random.default_rng(0)
        self.create_subscription(LaserScan, '/scan', self.on_scan, QoSPresetProfiles.SENSOR_DATA.value)
        self.pub = self.create_publisher(TwistStamped, '/cmd_vel', 10)
        self.marker = self.create_publisher(Marker, '/wall', 1)
        self.last = None
        self.count = 0

    def ransac(self, pts):
        best, inliers = None, np.zeros(len(pts), bool)
        for _ in range(40):
            i, j = self.rng.choice(len(pts), 2, replace=False)
            d = pts[j] - pts[i]
            norm = np.linalg.norm(d)
            if norm < 1e-6:
                continue
            n = np.array([-d[1], d[0]]) / norm
            ok = np.abs((pts - pts[i]) @ n) < 0.03
            if ok.sum() > inliers.sum():
                best, inliers = n, ok
        return best, inliers

    def on_scan(self, msg):
        a = msg.angle_min + np.arange(len(msg.ranges)) * msg.angle_increment
        a = np.arctan2(np.sin(a), np.cos(a))
        r = np.array(msg.ranges)
        right = np.isfinite(r) & (r > msg.range_min) & (a > -math.radians(120)) & (a < -math.radians(20)) & (r < 3.0)
        ahead = np.isfinite(r) & (r > msg.range_min) & (np.abs(a) < math.radians(20))
        cmd = TwistStamped()
        cmd.header.stamp = self.get_clock().now().to_msg()
        cmd.header.frame_id = 'base_link'
        v = self.get_parameter('velocity').get_parameter_value().double_value
        want = self.get_parameter('distance').get_parameter_value().double_value
        front = r[ahead].min() if ahead.any() else math.inf
        if front < want + 0.15:
            cmd.twist.angular.z = 0.8
        elif right.sum() >= 4:
            pts = np.column_stack([r[right] * np.cos(a[right]), r[right] * np.sin(a[right])])
            n, ok = self.ransac(pts)
            foot = pts[ok].mean(axis=0)
            if n @ foot < 0:
                n = -n
            distance = abs(n @ foot)
            heading = math.atan2(n[0], -n[1])
            error = want - distance
            cmd.twist.linear.x = v
            cmd.twist.angular.z = float(np.clip(np.clip(1.5 * error, -0.5, 0.5) + 1.2 * heading, -0.8, 0.8))
            self.draw(pts[ok])
            self.count += 1
            if self.count % 20 == 0:
                self.get_logger().info(f'wall at {distance:.2f} m, {ok.sum()} inliers')
        else:
            cmd.twist.linear.x = v      # no wall yet
        self.pub.publish(cmd)

    def draw(self, pts):
        m = Marker(type=Marker.LINE_STRIP, action=Marker.ADD)
        m.header.frame_id = 'base_scan'
        m.scale.x = 0.05
        m.color.r = m.color.a = 1.0
        m.points = [Point(x=float(x), y=float(y)) for x, y in pts]
        self.marker.publish(m)


def main(args=None):
    rclpy.init(args=args)
    node = WallFollower()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
