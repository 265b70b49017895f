#!/usr/bin/env python3
"""Drive a 1 m square by dead reckoning (timing only)."""
import math
from time import sleep

import rclpy
from geometry_msgs.msg import Twist, Vector3

LINEAR = 0.25
ANGULAR = 0.5


def go(pub, v, w, duration):
    steps = int(duration * 10)
    for i in range(steps):
        pub.publish(Twist(linear=Vector3(x=v), angular=Vector3(z=w)))
        sleep(0.1)


def main():
    rclpy.init()
    node = rclpy.create_node('square')
    pub = node.create_publisher(Twist, 'cmd_vel', 10)
    sleep(0.5)

    for side in range(1, 5):
        node.get_logger().info('Side %d' % side)
        go(pub, LINEAR, 0.0, 1.0 / LINEAR)
        go(pub, 0.0, 0.0, 0.5)
        go(pub, 0.0, ANGULAR, (math.pi / 2) / ANGULAR)
        go(pub, 0.0, 0.0, 0.5)

    node.get_logger().info('Square finished')
    rclpy.shutdown()


if __name__ == '__main__':
    main()
