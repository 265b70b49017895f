"""A node that says once a second that it is alive."""

# Lesson: log `alive` once a second

import rclpy
from rclpy.node import Node


class Heartbeat(Node):
    def __init__(self):
        super().__init__("heartbeat")
        self.beat()

    def beat(self):
        self.get_logger().info("alive")


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(Heartbeat())


if __name__ == "__main__":
    main()
