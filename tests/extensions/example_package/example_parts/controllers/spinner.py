"""Turns on the spot."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class Spinner(Node):
    def __init__(self):
        super().__init__("spinner")
        self.publisher = self.create_publisher(Twist, "cmd_vel", 1)
        self.create_timer(0.1, self.spin)

    def spin(self):
        command = Twist()
        command.angular.z = 2.0
        self.publisher.publish(command)


def main():
    rclpy.init()
    rclpy.spin(Spinner())


if __name__ == "__main__":
    main()
