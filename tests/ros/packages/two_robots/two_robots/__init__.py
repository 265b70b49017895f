#!/usr/bin/env python3
import rclpy
from flatland_msgs.msg import Collisions
from flatland_msgs.srv import MoveModel
from geometry_msgs.msg import Pose2D, Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node
from rclpy.publisher import Publisher
from tf_transformations import euler_from_quaternion

from .driving.homing import *


class Pair(Node):
    """Drives both robots forward; whoever bumps into a wall is sent home."""

    def __init__(self) -> None:
        super().__init__('Pair')
        self.declare_parameter('speed', 0.5)
        self.declare_parameter('greeting', 'hello')
        self.pub: dict = {}
        self.homes = {'left': (-0.5, 0.0), 'right': (0.5, 0.0)}
        self.sent_home = 0
        for name in self.homes:
            self.pub[name] = self.create_publisher(Twist, '/' + name + '/cmd_vel', 1)
            self.create_subscription(Odometry, '/' + name + '/odom', lambda msg, who=name: self.on_odometry(msg, who), 1)
            self.create_subscription(Collisions, '/' + name + '/collisions', lambda msg, who=name: self.on_collision(msg, who), 1)
        self.get_logger().info(self.get_parameter('greeting').value)

    def on_odometry(self, msg, who):
        orientation = msg.pose.pose.orientation
        heading = euler_from_quaternion([orientation.x, orientation.y, orientation.z, orientation.w])[2]
        twist = Twist()
        twist.linear.x = self.get_parameter('speed').value if who == 'left' else -self.get_parameter('speed').value
        twist.angular.z = steer(heading)
        self.pub[who].publish(twist)

    def on_collision(self, msg, who):
        if len(msg.collisions) > 0:
            self.sent_home += 1
            self.get_logger().info(f'{who} goes home, time {self.sent_home}')
            self.move_model(who, *self.homes[who])

    def move_model(self, name, x, y):
        client = self.create_client(MoveModel, '/move_model')
        client.wait_for_service()
        request = MoveModel.Request()
        request.name = name
        request.pose = Pose2D()
        request.pose.x = x
        request.pose.y = y
        request.pose.theta = 1.5708
        client.call_async(request)


def main(args=None):
    rclpy.init()
    rclpy.spin(Pair())


if __name__ == '__main__':
    main()
