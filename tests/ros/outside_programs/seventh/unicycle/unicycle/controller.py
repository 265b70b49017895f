import itertools
import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class Controller(Node):
    """Open loop: four sides, four quarter turns, then nothing more is sent."""

    def __init__(self):
        super().__init__('controller')
        self.declare_parameter('side', 2.0)
        self.declare_parameter('speed', 0.2)
        self.declare_parameter('turn_rate', 0.5)
        side, v, w = (p.value for p in self.get_parameters(['side', 'speed', 'turn_rate']))
        plan = [(side / v, (v, 0.0)), (math.pi / 2 / w, (0.0, w))] * 4
        self.ends = list(itertools.accumulate(t for t, _ in plan))
        self.commands = [u for _, u in plan]
        self.pub = self.create_publisher(Twist, 'control', 10)
        self.t0 = None
        self.timer = self.create_timer(0.02, self.step)

    def step(self):
        now = self.get_clock().now()
        if self.t0 is None:
            if self.pub.get_subscription_count() == 0:
                return
            self.t0 = now
        elapsed = (now - self.t0).nanoseconds / 1e9
        for end, (v, w) in zip(self.ends, self.commands):
            if elapsed < end:
                msg = Twist()
                msg.linear.x = v
                msg.angular.z = w
                self.pub.publish(msg)
                return
        self.pub.publish(Twist())
        self.get_logger().info('square done')
        self.timer.cancel()


def main():
    rclpy.init()
    rclpy.spin(Controller())
