#!/usr/bin/env python3
# triangle; each leg is ended by a threading.Timer, the main thread only publishes
import math
import threading
import time

import rclpy
from geometry_msgs.msg import Twist

phase = 0
lock = threading.Lock()
PLAN = [(1.5, 0.0, 2.0), (0.0, 2 * math.pi / 3, 1.0)] * 3


def next_phase():
    global phase
    with lock:
        phase += 1
        if phase < len(PLAN):
            threading.Timer(PLAN[phase][2], next_phase).start()


def main():
    rclpy.init()
    node = rclpy.create_node('triangle')
    pub = node.create_publisher(Twist, '/turtle1/cmd_vel', 10)
    while pub.get_subscription_count() == 0:
        time.sleep(0.05)
    threading.Timer(PLAN[0][2], next_phase).start()
    t = Twist()
    while True:
        with lock:
            p = phase
        if p == len(PLAN):
            break
        t.linear.x, t.angular.z = PLAN[p][:2]
        pub.publish(t)
        time.sleep(0.01)
    pub.publish(Twist())
    time.sleep(0.2)
    node.get_logger().info('triangle closed')
    rclpy.shutdown()


if __name__ == '__main__':
    main()
