#!/usr/bin/env python3
from math import pi
from time import perf_counter
import rclpy
from geometry_msgs.msg import Twist


def main(args=None):
    rclpy.init(args=args)
    node = rclpy.create_node('circle')
    publisher = node.create_publisher(Twist, '/turtle1/cmd_vel', 10)

    while rclpy.ok() and publisher.get_subscription_count() == 0:
        rclpy.spin_once(node, timeout_sec=0.1)

    speed = 2.0
    radius = 1.5
    msg = Twist()
    msg.linear.x = speed
    msg.angular.z = speed / radius

    t0 = perf_counter()
    angle = 0
    while angle < 2 * pi:
        publisher.publish(msg)
        t1 = perf_counter()
        angle = (speed / radius) * (t1 - t0)
        rclpy.spin_once(node, timeout_sec=0.01)

    publisher.publish(Twist())
    node.get_logger().info('full circle: %.2f rad' % angle)
    rclpy.spin_once(node, timeout_sec=0.3)
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
