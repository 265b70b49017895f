#!/usr/bin/env python3
"""The newer style: rclpy.init() as a context manager, a contextlib stack, atexit, and a plain loop."""
import atexit
import contextlib
import time
import rclpy
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from geometry_msgs.msg import TwistStamped
from std_msgs.msg import String


@contextlib.contextmanager
def stopwatch(log, name):
    t = time.perf_counter_ns()
    yield
    log.info(f'{name}: {(time.perf_counter_ns() - t) / 1e9:.1f} s')


@contextlib.contextmanager
def own(node):
    try:
        yield node
    finally:
        node.get_logger().info('destroyed')
        node.destroy_node()


def main():
    atexit.register(print, 'goodbye')
    with contextlib.ExitStack() as stack:
        stack.enter_context(rclpy.init(signal_handler_options=SignalHandlerOptions.NO))
        node = stack.enter_context(own(Node('tidy')))
        pub = node.create_publisher(TwistStamped, 'cmd_vel_stamped', 10)
        words = node.create_publisher(String, '~/words', 10)
        with stopwatch(node.get_logger(), 'three commands'):
            for v in (0.1, 0.2, 0.3):
                m = TwistStamped()
                m.header.stamp = node.get_clock().now().to_msg()
                m.header.frame_id = 'base_link'
                m.twist.linear.x = v
                pub.publish(m)
                words.publish(String(data=f'{v:.1f}'))
                rclpy.spin_once(node, timeout_sec=1.0)
        with stopwatch(node.get_logger(), 'lap'):
            deadline = time.monotonic() + 1.5
            while time.monotonic() < deadline:
                time.sleep(0.01)
    print('still inited:', rclpy.ok())


if __name__ == '__main__':
    main()
