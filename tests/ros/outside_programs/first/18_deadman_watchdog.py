#!/usr/bin/env python3
import rclpy
from rclpy.node import Node
from rclpy.duration import Duration
from geometry_msgs.msg import Twist


class Watchdog(Node):

    def __init__(self):
        super().__init__('deadman')
        self.timeout = Duration(seconds=0.5)
        self.last = None
        self.last_msg = Twist()
        self.dead = False
        self.sub = self.create_subscription(Twist, 'teleop/cmd_vel', self.relay, 10)
        self.pub = self.create_publisher(Twist, 'cmd_vel', 10)
        self.timer = self.create_timer(0.05, self.check)

    def relay(self, msg):
        if self.dead:
            self.get_logger().info('teleop is back')
            self.dead = False
        self.last = self.get_clock().now()
        self.last_msg = msg

    def check(self):
        if self.last is None:
            return
        age = self.get_clock().now() - self.last
        if age > self.timeout:
            if not self.dead:
                self.get_logger().warn('no command for {:.1f} s, stopping'.format(age.nanoseconds / 1e9))
                self.dead = True
            self.last_msg = Twist()
        self.pub.publish(self.last_msg)


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(Watchdog())
    rclpy.shutdown()


if __name__ == '__main__':
    main()
