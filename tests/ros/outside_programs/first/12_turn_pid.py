#!/usr/bin/env python3
"""usage: turn_pid.py --degrees 135 [--kp 1.2] [--ki 0.0] [--kd 0.1]"""
import argparse
import math
import sys

import rclpy
import rclpy.utilities
from rclpy.node import Node
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
import numpy as np


class PID:
    def __init__(self, kp, ki, kd, limit):
        self.kp, self.ki, self.kd, self.limit = kp, ki, kd, limit
        self.integral = 0.0
        self.last = None

    def __call__(self, error, dt):
        self.integral = np.clip(self.integral + error * dt, -1.0, 1.0)
        derivative = 0.0 if self.last is None or dt <= 0 else (error - self.last) / dt
        self.last = error
        out = self.kp * error + self.ki * self.integral + self.kd * derivative
        return float(np.clip(out, -self.limit, self.limit))


class Turner(Node):
    def __init__(self, opts):
        super().__init__('turner')
        self.target = None
        self.rotation = math.radians(opts.degrees)
        self.pid = PID(opts.kp, opts.ki, opts.kd, 0.9)
        self.pub = self.create_publisher(Twist, 'cmd_vel', 10)
        self.sub = self.create_subscription(Odometry, 'odom', self.update, 10)
        self.last_stamp = None
        self.settled = 0

    def update(self, odom):
        q = odom.pose.pose.orientation
        yaw = math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z))
        stamp = odom.header.stamp.sec + odom.header.stamp.nanosec * 1e-9
        if self.target is None:
            self.target = yaw + self.rotation
            self.last_stamp = stamp
            return
        err = self.target - yaw
        err = np.arctan2(np.sin(err), np.cos(err))
        dt = stamp - self.last_stamp
        self.last_stamp = stamp
        cmd = Twist()
        cmd.angular.z = self.pid(err, dt)
        self.pub.publish(cmd)
        if abs(err) < math.radians(2.0):
            self.settled += 1
        else:
            self.settled = 0

    def done(self):
        return self.settled > 10


def main():
    rclpy.init(args=sys.argv)
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--degrees', type=float, required=True)
    parser.add_argument('--kp', type=float, default=1.2)
    parser.add_argument('--ki', type=float, default=0.0)
    parser.add_argument('--kd', type=float, default=0.1)
    opts = parser.parse_args(rclpy.utilities.remove_ros_args(sys.argv)[1:])

    node = Turner(opts)
    node.get_logger().info(f'Turning by {opts.degrees} degrees')
    while rclpy.ok() and not node.done():
        rclpy.spin_once(node, timeout_sec=0.5)
    node.pub.publish(Twist())
    node.get_logger().info('Settled at the new heading')
    rclpy.spin_once(node, timeout_sec=0.2)
    node.pub.publish(Twist())
    rclpy.spin_once(node, timeout_sec=0.2)
    node.destroy_node()
    rclpy.shutdown()
    return 0


if __name__ == '__main__':
    sys.exit(main())
