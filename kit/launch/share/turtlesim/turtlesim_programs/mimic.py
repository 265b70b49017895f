"""Drives one turtle as another one drives: from ``input/pose`` to ``output/cmd_vel``; remap both."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from turtlesim.msg import Pose


class MimicNode(Node):
    """Publishes the speeds that it hears of."""

    def __init__(self) -> None:
        super().__init__("turtle_mimic")
        self.publisher = self.create_publisher(Twist, "output/cmd_vel", 1)
        self.create_subscription(Pose, "input/pose", self.on_pose, 1)

    def on_pose(self, pose: Pose) -> None:
        command = Twist()
        command.linear.x = pose.linear_velocity
        command.angular.z = pose.angular_velocity
        self.publisher.publish(command)


def main() -> None:
    rclpy.init()
    rclpy.spin(MimicNode())
