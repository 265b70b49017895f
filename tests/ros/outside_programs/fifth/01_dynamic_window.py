#!/usr/bin/env python3
"""Dynamic window approach (Fox, Burgard, Thrun), after the lecture: sample (v, w), roll out, score, drive the best."""
import math

import numpy as np
import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import LaserScan


class Dwa(Node):
    def __init__(self):
        super().__init__('dwa')
        self.goal = np.array([3.0, -2.0])
        self.pose = None
        self.v = self.w = 0.0
        self.points = np.empty((0, 2))
        self.pub = self.create_publisher(Twist, 'cmd_vel', 1)
        self.create_subscription(Odometry, 'odom', self.on_odom, 10)
        self.create_subscription(LaserScan, 'scan', self.on_scan, qos_profile_sensor_data)
        self.timer = self.create_timer(0.1, self.plan)
        self.done = False

    def on_odom(self, msg):
        q = msg.pose.pose.orientation
        self.pose = np.array([msg.pose.pose.position.x, msg.pose.pose.position.y,
                              math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y ** 2 + q.z ** 2))])
        self.v, self.w = msg.twist.twist.linear.x, msg.twist.twist.angular.z

    def on_scan(self, msg):
        r = np.asarray(msg.ranges)
        a = msg.angle_min + np.arange(len(r)) * msg.angle_increment
        ok = np.isfinite(r) & (r > msg.range_min)
        self.points = np.stack([r[ok] * np.cos(a[ok]), r[ok] * np.sin(a[ok])], axis=1)

    def rollout(self, v, w):
        x = y = t = 0.0
        path = []
        for _ in range(15):
            t += w * 0.1
            x += v * math.cos(t) * 0.1
            y += v * math.sin(t) * 0.1
            path.append((x, y))
        return np.array(path), t

    def plan(self):
        if self.pose is None:
            return
        dx, dy = self.goal - self.pose[:2]
        if math.hypot(dx, dy) < 0.15:
            self.pub.publish(Twist())
            self.get_logger().info('goal reached at %.1f %.1f' % (self.pose[0], self.pose[1]))
            self.done = True
            return
        c, s = math.cos(-self.pose[2]), math.sin(-self.pose[2])
        gx, gy = c * dx - s * dy, s * dx + c * dy
        best, command = -math.inf, (0.0, 0.0)
        for v in np.linspace(max(0.0, self.v - 0.1), min(0.5, self.v + 0.1), 5):
            for w in np.linspace(max(-1.5, self.w - 0.4), min(1.5, self.w + 0.4), 9):
                path, t = self.rollout(v, w)
                if len(self.points):
                    gap = np.min(np.linalg.norm(path[:, None] - self.points[None], axis=2))
                    if gap < 0.25:
                        continue
                else:
                    gap = 2.0
                end = path[-1]
                heading = abs(math.remainder(math.atan2(gy - end[1], gx - end[0]) - t, math.tau))
                score = -2.0 * math.hypot(gx - end[0], gy - end[1]) - 0.3 * heading + 0.1 * min(gap, 1.0)
                if score > best:
                    best, command = score, (float(v), float(w))
        msg = Twist()
        msg.linear.x, msg.angular.z = command
        self.pub.publish(msg)


def main():
    rclpy.init()
    node = Dwa()
    while rclpy.ok() and not node.done:
        rclpy.spin_once(node)
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
