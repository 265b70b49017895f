"""Prints what it hears on ``chatter``."""

import rclpy
from rclpy.node import Node
from std_msgs.msg import String


class Listener(Node):
    """Logs every text."""

    def __init__(self) -> None:
        super().__init__("listener")
        self.create_subscription(String, "chatter", self.hear, 10)

    def hear(self, message: String) -> None:
        self.get_logger().info(f"I heard: [{message.data}]")


def main() -> None:
    rclpy.init()
    rclpy.spin(Listener())
