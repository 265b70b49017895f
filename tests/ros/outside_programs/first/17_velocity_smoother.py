#!/usr/bin/env python3
from typing import Optional

import rclpy
import rclpy.node
from geometry_msgs.msg import Twist


def approach(current: float, target: float, step: float) -> float:
    if current < target:
        return min(current + step, target)
    return max(current - step, target)


class VelocitySmoother(rclpy.node.Node):
    def __init__(self):
        super().__init__('velocity_smoother')
        self.acc_lin = self.declare_parameter('acc_lin', 0.2).value      # m/s^2
        self.acc_ang = self.declare_parameter('acc_ang', 0.5).value
        self.freq = self.declare_parameter('frequency', 20.0).value
        self.target: Optional[Twist] = None
        self.out = Twist()
        self.peak = 0.0
        self.create_subscription(Twist, 'cmd_vel_raw', self.raw_cb, 10)
        self.pub = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_timer(1.0 / self.freq, self.smooth)

    def raw_cb(self, msg):
        self.target = msg

    def smooth(self):
        if self.target is None:
            return
        self.out.linear.x = approach(self.out.linear.x, self.target.linear.x, self.acc_lin / self.freq)
        self.out.angular.z = approach(self.out.angular.z, self.target.angular.z, self.acc_ang / self.freq)
        self.pub.publish(self.out)
        if abs(self.out.linear.x - 0.4) < 1e-6 and self.peak == 0.0:
            self.peak = self.out.linear.x
            self.get_logger().info('full speed')
        if self.peak > 0.0 and abs(self.out.linear.x) < 1e-6:
            self.get_logger().info('smoothly stopped', once=True)


def main():
    rclpy.init()
    node = VelocitySmoother()
    rclpy.spin(node)


if __name__ == '__main__':
    main()
