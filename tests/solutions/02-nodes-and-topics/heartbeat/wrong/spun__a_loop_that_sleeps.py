"""A node that says once a second that it is alive."""

# Lesson: {file} holds a node that is spun

import time

import rclpy
from rclpy.node import Node


def main(args=None):
    rclpy.init(args=args)
    node = Node("heartbeat")
    while rclpy.ok():
        node.get_logger().info("alive")
        time.sleep(1.0)


if __name__ == "__main__":
    main()
