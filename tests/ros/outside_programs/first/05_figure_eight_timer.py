#! /usr/bin/env python3

import rclpy
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from geometry_msgs.msg import Twist
from math import pi


class FigureEight(Node):
    """Two loops: first anticlockwise, then clockwise, stop where we began."""

    def __init__(self):
        super().__init__("figure_eight")
        self.my_publisher = self.create_publisher(msg_type=Twist, topic="cmd_vel", qos_profile=10)
        self.loop_time = 15.0                   # s for each loop
        self.radius = 0.5
        self.timer = self.create_timer(timer_period_sec=1 / 10, callback=self.timer_callback)
        self.start = None
        self.shutdown_done = False
        self.get_logger().info(f"The '{self.get_name()}' node is initialised.")

    def timer_callback(self):
        if self.my_publisher.get_subscription_count() == 0:
            return
        now = self.get_clock().now().nanoseconds * 1e-9
        if self.start is None:
            self.start = now
        t = now - self.start
        ang_vel = 2 * pi / self.loop_time
        cmd = Twist()
        if t < self.loop_time:
            cmd.linear.x = ang_vel * self.radius
            cmd.angular.z = ang_vel
            self.get_logger().info("loop one", throttle_duration_sec=5.0)
        elif t < 2 * self.loop_time:
            cmd.linear.x = ang_vel * self.radius
            cmd.angular.z = -ang_vel
            self.get_logger().info("loop two", throttle_duration_sec=5.0)
        else:
            self.get_logger().info("finished", once=True)
        self.my_publisher.publish(cmd)

    def on_shutdown(self):
        self.my_publisher.publish(Twist())
        self.shutdown_done = True


def main(args=None):
    rclpy.init(args=args, signal_handler_options=SignalHandlerOptions.NO)
    node = FigureEight()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        print("Shutdown request detected")
    finally:
        node.on_shutdown()
        node.destroy_node()
        rclpy.shutdown()


if __name__ == "__main__":
    main()
