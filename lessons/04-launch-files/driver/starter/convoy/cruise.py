"""Drives ahead at a steady speed. Its parameter is `speed` [m/s]; it
publishes on the topic `command`."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class Cruise(Node):
    def __init__(self):
        super().__init__("cruise")
        self.declare_parameter("speed", 0.1)
        self.publisher = self.create_publisher(Twist, "command", 10)
        self.create_timer(0.1, self.go)

    def go(self):
        command = Twist()
        command.linear.x = self.get_parameter("speed").value
        self.publisher.publish(command)


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(Cruise())


if __name__ == "__main__":
    main()
