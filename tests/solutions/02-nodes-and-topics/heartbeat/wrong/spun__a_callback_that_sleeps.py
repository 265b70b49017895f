"""A node that says once a second that it is alive."""

# Lesson: {file} holds a node that is spun

import time

import rclpy
from rclpy.node import Node


class Heartbeat(Node):
    def __init__(self):
        super().__init__("heartbeat")
        self.create_timer(0.01, self.beat)

    def beat(self):
        self.get_logger().info("alive")
        time.sleep(1.0)


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(Heartbeat())


if __name__ == "__main__":
    main()
