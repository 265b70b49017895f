"""Drives ahead until it bumps, and is to be sent home then.

The world has a service for it: /move_model, of the type MoveModel, puts a model at a pose.
"""

# Lesson: A client is made once; each call takes a request.

import rclpy
from flatland_msgs.msg import Collisions
from flatland_msgs.srv import MoveModel
from geometry_msgs.msg import Pose2D, Twist
from rclpy.node import Node


class Home(Node):
    def __init__(self):
        super().__init__("home")
        self.home = self.declare_parameter("home", [0.0, 0.0, 0.0]).value  # x, y, theta
        self.model = self.declare_parameter("model", "serp").value  # the robot's name in the world
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(Collisions, "collisions", self.on_collisions, 10)
        self.create_timer(0.1, self.go)
        self.move = self.create_publisher(Pose2D, "/move_model", 10)

    def go(self):
        command = Twist()
        command.linear.x = 0.6
        self.drive.publish(command)

    def on_collisions(self, message):
        """Called ten times a second; message.collisions lists what touches the robot."""
        if not message.collisions:
            return
        x, y, theta = self.home
        self.move.publish(Pose2D(x=x, y=y, theta=theta))


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(Home())


if __name__ == "__main__":
    main()
