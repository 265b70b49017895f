#!/usr/bin/env python3
"""Behaviours as generators: each yields a Twist per control cycle until it is done."""
import math
import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry


def T(v, w):
    t = Twist()
    t.linear.x = float(v)
    t.angular.z = float(w)
    return t


class Mower(Node):
    def __init__(self, lanes, length, spacing):
        super().__init__('mower')
        self.pose = None
        self.pub = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(Odometry, 'odom', self.on_odom, 10)
        self.plan = self.mow(lanes, length, spacing)
        self.create_timer(0.1, self.cycle)

    def on_odom(self, m):
        q = m.pose.pose.orientation
        self.pose = (m.pose.pose.position.x, m.pose.pose.position.y,
                     math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y ** 2 + q.z ** 2)))

    def straight(self, dist, heading):
        x0, y0, _ = self.pose
        while True:
            x, y, th = self.pose
            done = math.hypot(x - x0, y - y0)
            if done >= dist:
                return
            yield T(min(0.5, 0.15 + (dist - done)), 1.5 * math.remainder(heading - th, math.tau))

    def turn(self, heading):
        while True:
            e = math.remainder(heading - self.pose[2], math.tau)
            if abs(e) < 0.05:
                return
            yield T(0, max(-0.9, min(0.9, 2.0 * e)))

    def mow(self, lanes, length, spacing):
        heading = 0.0
        for lane in range(lanes):
            yield from self.straight(length, heading)
            self.get_logger().info(f'lane {lane + 1} mown')
            if lane == lanes - 1:
                return
            yield from self.turn(math.pi / 2)
            yield from self.straight(spacing, math.pi / 2)
            heading = math.pi - heading
            yield from self.turn(heading)

    def cycle(self):
        if self.pose is None:
            return
        try:
            self.pub.publish(next(self.plan))
        except StopIteration:
            self.pub.publish(T(0, 0))
            self.get_logger().info('lawn finished', once=True)


if __name__ == '__main__':
    rclpy.init()
    rclpy.spin(Mower(lanes=3, length=2.0, spacing=0.7))
