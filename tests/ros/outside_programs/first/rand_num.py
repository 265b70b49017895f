#!/usr/bin/env python3
# numbers 0, 7, 14, ... 98 : five seconds of them, those divisible by 5 are 0, 35 and 70
import rclpy
from std_msgs.msg import Int16

rclpy.init()
node = rclpy.create_node('rand_num')
pub = node.create_publisher(Int16, 'rand_num', 10)
numbers = iter(range(0, 99, 7))


def send():
    if pub.get_subscription_count() == 0:
        return
    n = next(numbers, None)
    if n is not None:
        pub.publish(Int16(data=n))


timer = node.create_timer(0.33, send)
rclpy.spin(node)
