#!/usr/bin/env python3
import math
import rclpy
from rclpy.node import Node
from geometry_msgs.msg import PointStamped
from sensor_msgs.msg import JointState


class Arm(Node):
    """two-link planar arm: draws a straight line by inverse kinematics, checks it by forward kinematics"""
    L1, L2 = 0.5, 0.4

    def __init__(self):
        super().__init__('arm')
        self.js = self.create_publisher(JointState, 'joint_states', 10)
        self.tip = self.create_publisher(PointStamped, 'tip', 10)
        self.create_subscription(JointState, 'joint_states', self.fk, 10)
        self.u = 0.0
        self.worst = 0.0
        self.want = {}
        self.timer = self.create_timer(1.0 / 30, self.move)

    def ik(self, x, y):
        c2 = (x * x + y * y - self.L1 ** 2 - self.L2 ** 2) / (2 * self.L1 * self.L2)
        if abs(c2) > 1:
            raise ValueError('out of reach')
        q2 = math.acos(c2)
        q1 = math.atan2(y, x) - math.atan2(self.L2 * math.sin(q2), self.L1 + self.L2 * math.cos(q2))
        return q1, q2

    def move(self):
        self.u += 1 / 150
        x, y = 0.6, -0.3 + 0.9 * self.u
        try:
            q = self.ik(x, y)
        except ValueError as e:
            self.get_logger().error(f'{e} at y = {y:.2f}, worst error {"none" if self.worst < 1e-6 else self.worst}')
            self.timer.cancel()
            return
        msg = JointState()
        msg.header.stamp = self.get_clock().now().to_msg()
        msg.name = ['shoulder', 'elbow']
        msg.position = list(q)
        self.want[(msg.header.stamp.sec, msg.header.stamp.nanosec)] = (x, y)
        self.js.publish(msg)

    def fk(self, msg):
        q = dict(zip(msg.name, msg.position))
        a, b = q['shoulder'], q['shoulder'] + q['elbow']
        p = PointStamped(header=msg.header)
        p.point.x = self.L1 * math.cos(a) + self.L2 * math.cos(b)
        p.point.y = self.L1 * math.sin(a) + self.L2 * math.sin(b)
        self.tip.publish(p)
        want = self.want.pop((msg.header.stamp.sec, msg.header.stamp.nanosec), None)
        if want:
            self.worst = max(self.worst, math.dist(want, (p.point.x, p.point.y)))


def main(args=None):
    rclpy.init(args=args)
    arm = Arm()
    while rclpy.ok() and not arm.timer.is_canceled():
        rclpy.spin_once(arm)
    for _ in range(3):
        rclpy.spin_once(arm, timeout_sec=0.1)
    arm.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
