#!/usr/bin/env python3
"""Keyboard teleop without the keyboard: the keys come as one word, one key is one second.

w forward, s backward, a left, d right, x stop
"""
import sys
import rclpy
from geometry_msgs.msg import Twist

moveBindings = {
    'w': (1, 0),
    's': (-1, 0),
    'a': (0, 1),
    'd': (0, -1),
    'x': (0, 0),
}
speed = 0.4
turn = 0.785398


def vels(speed, turn):
    return 'currently:\tspeed %s\tturn %s ' % (speed, turn)


def main():
    keys = sys.argv[1] if len(sys.argv) > 1 else 'wasd'
    rclpy.init()
    node = rclpy.create_node('teleop_keys')
    pub = node.create_publisher(Twist, 'cmd_vel', 10)
    try:
        print(vels(speed, turn))
        # settle
        for i in range(10):
            rclpy.spin_once(node, timeout_sec=0.1)
        for key in keys:
            if key not in moveBindings:
                print('unknown key', key)
                continue
            x, th = moveBindings[key]
            end = node.get_clock().now().nanoseconds + 1_000_000_000
            while node.get_clock().now().nanoseconds < end:
                twist = Twist()
                twist.linear.x = x * speed
                twist.angular.z = th * turn
                pub.publish(twist)
                rclpy.spin_once(node, timeout_sec=0.05)
    except Exception as e:
        print(e)
    finally:
        twist = Twist()
        pub.publish(twist)
        rclpy.spin_once(node, timeout_sec=0.1)
        pub.publish(twist)
        rclpy.spin_once(node, timeout_sec=0.1)
        print('bye')
        node.destroy_node()
        rclpy.shutdown()


if __name__ == '__main__':
    main()
