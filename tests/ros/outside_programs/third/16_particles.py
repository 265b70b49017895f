#!/usr/bin/env python3
"""Monte-Carlo localisation along a corridor in one dimension: where between the two walls is the robot?"""
import random
import numpy
import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Pose, PoseArray, Twist
from nav_msgs.msg import Odometry
from sensor_msgs.msg import LaserScan

LENGTH = 10.0


class Localiser(Node):
    def __init__(self, count=300):
        super().__init__('localiser')
        random.seed(3)
        self.rng = numpy.random.RandomState(3)
        self.p = self.rng.uniform(0, LENGTH, count)
        self.last_x, self.moved, self.scans = None, 0.0, 0
        self.cloud = self.create_publisher(PoseArray, 'particles', 10)
        self.cmd = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(Odometry, 'odom', self.on_odom, 10)
        self.create_subscription(LaserScan, 'scan', self.on_scan, 10)
        self.create_timer(0.2, self.drive)

    def drive(self):
        t = Twist()
        t.linear.x = 0.3
        self.cmd.publish(t)

    def on_odom(self, m):
        x = m.pose.pose.position.x
        if self.last_x is not None:
            self.moved += x - self.last_x
        self.last_x = x

    def on_scan(self, scan):
        self.scans += 1
        # motion
        self.p += self.moved + self.rng.normal(0, 0.02, self.p.size)
        self.moved = 0.0
        # measurement: ahead only, with a made-up noise
        z = scan.ranges[0] + random.gauss(0, 0.1)
        w = numpy.exp(-0.5 * ((LENGTH - self.p - z) / 0.2) ** 2) + 1e-12
        w /= w.sum()
        # low-variance resampling
        r, step = self.rng.uniform(0, 1 / self.p.size), 1 / self.p.size
        self.p = self.p[numpy.searchsorted(numpy.cumsum(w), r + step * numpy.arange(self.p.size)).clip(max=self.p.size - 1)]
        msg = PoseArray()
        msg.header = scan.header
        for x in self.p:
            pose = Pose()
            pose.position.x = float(x)
            msg.poses.append(pose)
        self.cloud.publish(msg)
        if self.scans % 20 == 0:
            error = abs(self.p.mean() - (LENGTH - scan.ranges[0]))
            self.get_logger().info('scan %d: spread %.2f, error %s' % (
                self.scans, self.p.std(), 'small' if error < 0.15 else 'LARGE'))


def main(args=None):
    rclpy.init(args=args)
    node = Localiser()
    for _ in range(2000):
        rclpy.spin_once(node, timeout_sec=1.0)
        if node.scans >= 60:
            break
    node.cmd.publish(Twist())
    rclpy.spin_once(node, timeout_sec=0.0)
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
