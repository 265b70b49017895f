"""A node that says once a second that it is alive."""

import rclpy
from rclpy.node import Node


class Heartbeat(Node):
    def __init__(self):
        # TODO: the node is to be called heartbeat
        super().__init__("nameless")
        # TODO: have self.beat called once a second

    def beat(self):
        self.get_logger().info("alive")


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(Heartbeat())


if __name__ == "__main__":
    main()
