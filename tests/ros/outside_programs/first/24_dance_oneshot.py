#!/usr/bin/env python3
# Every step of the dance arms a one-shot timer for the next step.
import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Twist

#         name        v     w    seconds
DANCE = [('forward',  0.3,  0.0, 2.0),
         ('spin',     0.0,  0.8, 4.0),
         ('back',    -0.3,  0.0, 2.0),
         ('curve',    0.2, -0.5, 3.0),
         ('bow',      0.0,  0.0, 1.0)]


class Dancer(Node):
    def __init__(self):
        super().__init__('dancer')
        self.pub = self.create_publisher(Twist, 'cmd_vel', 10)
        self.v = self.w = 0.0
        self.step = -1
        self.oneshot = None
        self.create_timer(0.05, self.publish)
        self.arm(1.0)

    def arm(self, seconds):
        if self.oneshot is not None:
            self.oneshot.cancel()
            self.destroy_timer(self.oneshot)
        self.oneshot = self.create_timer(seconds, self.next_step)

    def next_step(self):
        self.step += 1
        if self.step == len(DANCE):
            self.get_logger().info('applause')
            rclpy.shutdown()
            return
        name, self.v, self.w, seconds = DANCE[self.step]
        self.get_logger().info(name)
        self.arm(seconds)

    def publish(self):
        msg = Twist()
        msg.linear.x, msg.angular.z = self.v, self.w
        self.pub.publish(msg)


def main():
    rclpy.init()
    dancer = Dancer()
    rclpy.spin(dancer)


if __name__ == '__main__':
    main()
