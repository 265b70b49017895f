"""Drives one leg: speed [m/s], seconds, name."""
import sys

import rclpy
from geometry_msgs.msg import Twist


def main():
    rclpy.init()
    speed, seconds, name = float(sys.argv[1]), float(sys.argv[2]), sys.argv[3]
    node = rclpy.create_node("leg_" + name)
    pub = node.create_publisher(Twist, "cmd_vel", 10)
    start = node.get_clock().now()
    print(f"{name} starts", flush=True)
    ticks = 0

    def tick():
        nonlocal ticks
        ticks += 1
        msg = Twist()
        if ticks * 0.1 <= seconds:
            msg.linear.x = speed
        pub.publish(msg)
        if ticks * 0.1 > seconds + 0.35:
            raise SystemExit(0)

    node.create_timer(0.1, tick)
    try:
        rclpy.spin(node)
    finally:
        took = (node.get_clock().now() - start).nanoseconds * 1e-9
        print(f"{name} ends after {took:.1f} s", flush=True)


main()
