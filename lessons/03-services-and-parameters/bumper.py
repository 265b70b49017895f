"""Drives ahead; after a bump it asks the world to put it back where it started. For the lesson on services."""

import rclpy
from flatland_msgs.msg import Collisions
from flatland_msgs.srv import MoveModel
from geometry_msgs.msg import Pose2D, Twist
from rclpy.node import Node


class Bumper(Node):
    def __init__(self) -> None:
        super().__init__("bumper")
        self.home = self.declare_parameter("home", [0.0, 0.0, 0.0]).value  # x, y, theta
        self.model = self.declare_parameter("model", "serp").value
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        self.move = self.create_client(MoveModel, "/move_model")
        self.create_subscription(Collisions, "collisions", self.on_collisions, 10)
        self.create_timer(0.1, self.go)

    def go(self) -> None:
        command = Twist()
        command.linear.x = 0.5
        self.drive.publish(command)

    def on_collisions(self, message: Collisions) -> None:
        if message.collisions:
            x, y, theta = self.home
            request = MoveModel.Request(name=self.model, pose=Pose2D(x=x, y=y, theta=theta))
            self.get_logger().info("A bump: asking to be put back home.")
            self.move.call_async(request).add_done_callback(self.on_answer)

    def on_answer(self, future: object) -> None:
        self.get_logger().info("The world has answered: done.")


def main(args: list[str] | None = None) -> None:
    rclpy.init(args=args)
    rclpy.spin(Bumper())


if __name__ == "__main__":
    main()
