#!/usr/bin/env python3
"""No callbacks at all: ask for one odometry message whenever one is needed."""
import math
import rclpy
from rclpy.wait_for_message import wait_for_message
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry


def position(node):
    ok, msg = wait_for_message(Odometry, node, 'odom', time_to_wait=5.0)
    if not ok:
        raise RuntimeError('no odometry')
    return msg.pose.pose.position


def main():
    rclpy.init()
    node = rclpy.create_node('one_metre')
    pub = node.create_publisher(Twist, 'cmd_vel', 10)
    start = position(node)
    node.get_logger().info('start %.2f %.2f' % (start.x, start.y))
    cmd = Twist()
    cmd.linear.x = 0.2
    here = start
    while math.hypot(here.x - start.x, here.y - start.y) < 1.0:
        pub.publish(cmd)
        here = position(node)
    for _ in range(5):
        pub.publish(Twist())
        here = position(node)
    node.get_logger().info('end %.2f %.2f' % (here.x, here.y))
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
