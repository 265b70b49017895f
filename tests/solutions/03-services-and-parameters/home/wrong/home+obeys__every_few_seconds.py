# Lesson: ask the world, after every bump, to put the robot back home
import rclpy
from flatland_msgs.srv import MoveModel
from geometry_msgs.msg import Pose2D, Twist
from rclpy.node import Node


class Home(Node):
    """Goes home every 4.4 seconds, bump or no bump."""

    def __init__(self):
        super().__init__("home")
        self.home = self.declare_parameter("home", [0.0, 0.0, 0.0]).value
        self.model = self.declare_parameter("model", "serp").value
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_timer(0.1, self.go)
        self.create_timer(4.4, self.back)
        self.move = self.create_client(MoveModel, "/move_model")

    def go(self):
        command = Twist()
        command.linear.x = 0.6
        self.drive.publish(command)

    def back(self):
        x, y, theta = self.home
        self.move.call_async(MoveModel.Request(name=self.model, pose=Pose2D(x=x, y=y, theta=theta)))


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(Home())


if __name__ == "__main__":
    main()
