#!/usr/bin/env python3
"""Choreography by the standard library's event scheduler."""
import sched
import time
import rclpy
from geometry_msgs.msg import Twist, Vector3

MOVES = [  # at second, forward, turn
    (0.5, 0.3, 0.0),
    (2.5, 0.0, 0.8),
    (4.5, 0.3, 0.0),
    (6.5, 0.0, -0.8),
    (8.5, -0.3, 0.0),
    (10.5, 0.0, 0.0),
]


def main():
    rclpy.init()
    node = rclpy.create_node('dancer')
    publisher = node.create_publisher(Twist, 'cmd_vel', 10)
    scheduler = sched.scheduler(time.monotonic, time.sleep)
    begin = time.monotonic()

    def move(number, v, w):
        publisher.publish(Twist(linear=Vector3(x=v), angular=Vector3(z=w)))
        node.get_logger().info('move %d at %.1f' % (number, time.monotonic() - begin))

    for number, (at, v, w) in enumerate(MOVES):
        scheduler.enterabs(begin + at, 1, move, (number, v, w))
    cancelled = scheduler.enter(6.0, 1, move, kwargs={'number': 99, 'v': 1.0, 'w': 0.0})
    scheduler.enter(5.0, 2, scheduler.cancel, (cancelled,))
    scheduler.run()
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
