"""Random walk: forward until a wall is near, then a quarter turn to a random side.

A collision sends the robot back to where it started.
"""

import math
import random

import rclpy
from flatland_msgs.msg import Collisions
from flatland_msgs.srv import MoveModel
from geometry_msgs.msg import Pose2D, Twist
from rclpy.node import Node
from sensor_msgs.msg import LaserScan


class RandomWalk(Node):
    """Looks at the one ray straight ahead, ten times a second."""

    def __init__(self) -> None:
        super().__init__("random_walk")
        self.speed = self.declare_parameter("speed", 0.5).value  # m/s
        self.turn_rate = self.declare_parameter("turn_rate", math.pi / 2).value  # rad/s
        self.wall_distance = self.declare_parameter("wall_distance", 0.2).value  # m
        self.home = self.declare_parameter("home", [0.0, 0.0, -math.pi / 2]).value  # x, y, theta
        self.model = self.declare_parameter("model", "serp").value
        self.turning = 0  # scans left of the present turn
        self.side = 1  # +1 turns left, -1 right

        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        self.move_model = self.create_client(MoveModel, "/move_model")
        self.create_subscription(LaserScan, "static_laser", self.on_scan, 10)
        self.create_subscription(Collisions, "collisions", self.on_collisions, 10)

    def on_scan(self, scan: LaserScan) -> None:
        ahead = scan.ranges[len(scan.ranges) // 2]
        if self.turning == 0 and ahead < self.wall_distance:
            self.side = random.choice((1, -1))
            self.turning = 10  # ten scans at 10 Hz: one second, a quarter turn
        command = Twist()
        if self.turning > 0:
            self.turning -= 1
            command.angular.z = self.side * self.turn_rate
        else:
            command.linear.x = self.speed
        self.drive.publish(command)

    def on_collisions(self, message: Collisions) -> None:
        if not message.collisions:
            return
        self.get_logger().info("Bumped: back to the start.")
        self.turning = 0
        self.drive.publish(Twist())
        x, y, theta = self.home
        self.move_model.call_async(MoveModel.Request(name=self.model, pose=Pose2D(x=x, y=y, theta=theta)))


def main(args: list[str] | None = None) -> None:
    rclpy.init(args=args)
    rclpy.spin(RandomWalk())


if __name__ == "__main__":
    main()
