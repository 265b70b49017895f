"""Drives ahead until it bumps, and is to be sent home then.

The world has a service for it: /move_model, of the type MoveModel, puts
a model at a pose.
"""

import rclpy
from flatland_msgs.msg import Collisions
from flatland_msgs.srv import MoveModel
from geometry_msgs.msg import Pose2D, Twist
from rclpy.node import Node


class Home(Node):
    def __init__(self):
        super().__init__("home")
        # x, y, theta
        self.home = self.declare_parameter("home", [0.0, 0.0, 0.0]).value
        # the robot's name in the world
        self.model = self.declare_parameter("model", "serp").value
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(Collisions, "collisions", self.on_collisions, 10)
        self.create_timer(0.1, self.go)
        # TODO: a client for /move_model

    def go(self):
        command = Twist()
        command.linear.x = 0.6
        self.drive.publish(command)

    def on_collisions(self, message):
        """Called ten times a second; message.collisions lists what
        touches the robot."""
        if not message.collisions:
            return
        # TODO: ask for self.model to be put at self.home


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(Home())


if __name__ == "__main__":
    main()
