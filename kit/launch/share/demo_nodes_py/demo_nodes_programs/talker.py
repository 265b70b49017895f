"""Says hello on ``chatter`` once a second."""

import rclpy
from rclpy.node import Node
from std_msgs.msg import String


class Talker(Node):
    """Publishes a text with a growing number."""

    def __init__(self) -> None:
        super().__init__("talker")
        self.number = 0
        self.publisher = self.create_publisher(String, "chatter", 10)
        self.create_timer(1.0, self.say)

    def say(self) -> None:
        message = String(data=f"Hello World: {self.number}")
        self.number += 1
        self.get_logger().info(f'Publishing: "{message.data}"')
        self.publisher.publish(message)


def main() -> None:
    rclpy.init()
    rclpy.spin(Talker())
