#!/usr/bin/env python3
# 20 Hz gamepad: nothing held 1 s, slow ahead 3 s, turbo ahead 2 s, left turn 2 s, released 2 s with the stick still ahead
import rclpy
from sensor_msgs.msg import Joy

SCRIPT = [(20, 1.0, 0.0, 0, 0), (60, 1.0, 0.0, 1, 0), (40, 1.0, 0.0, 1, 1), (40, 0.0, 1.0, 1, 0), (40, 1.0, 0.0, 0, 1)]


def frames():
    for n, lin, ang, enable, turbo in SCRIPT:
        for _ in range(n):
            joy = Joy()
            joy.axes = [0.0, lin, 0.0, ang]
            joy.buttons = [0, 0, 0, 0, enable, turbo]
            yield joy


rclpy.init()
node = rclpy.create_node('fake_joy')
pub = node.create_publisher(Joy, 'joy', 10)
todo = frames()


def tick():
    if pub.get_subscription_count():
        joy = next(todo, None)
        if joy is None:
            raise SystemExit
        joy.header.stamp = node.get_clock().now().to_msg()
        pub.publish(joy)


node.create_timer(0.05, tick)
rclpy.spin(node)
