"""Stops the robot in every way out: a signal handler of its own, a hook of the context, and `finally`."""

import os
import signal
import threading

import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from rclpy.utilities import get_default_context
from rclpy.wait_for_message import wait_for_message


class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        self.pub = self.create_publisher(Twist, "/cmd_vel", 10)
        self.timer = self.create_timer(0.1, self.drive)
        self.ticks = 0

    def drive(self):
        self.ticks += 1
        twist = Twist()
        twist.linear.x = 0.3
        self.pub.publish(twist)
        if self.ticks == 20:
            os.kill(os.getpid(), signal.SIGINT)

    def stop(self):
        self.timer.cancel()
        self.pub.publish(Twist())


def main():
    asked = threading.Event()

    def on_signal(number, frame):
        print("signal", signal.Signals(number).name, flush=True)
        asked.set()

    signal.signal(signal.SIGINT, on_signal)
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    get_default_context().on_shutdown(lambda: print("context is shut down", flush=True))
    node = Driver()
    try:
        while rclpy.ok() and not asked.is_set():
            rclpy.spin_once(node, timeout_sec=0.5)
    finally:
        node.stop()
    for _ in range(20):
        got, odom = wait_for_message(Odometry, node, "/odom", time_to_wait=1.0)
        if got and abs(odom.twist.twist.linear.x) < 1e-3:
            break
    print(f"stands at {odom.pose.pose.position.x:.1f}, {node.ticks} ticks", flush=True)
    got, nothing = wait_for_message(Odometry, node, "/nobody", time_to_wait=0.3)
    print("nobody:", got, nothing, flush=True)
    node.destroy_node()
    rclpy.shutdown()
    try:
        rclpy.shutdown()
    except RuntimeError as error:
        print("again:", error, flush=True)
    print("ok", rclpy.ok(), flush=True)
    rclpy.init()
    with_again = rclpy.create_node("second_life")
    print(with_again.get_fully_qualified_name(), rclpy.ok())
    rclpy.shutdown()


if __name__ == "__main__":
    main()
