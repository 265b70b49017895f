#!/usr/bin/env python3
import rclpy
from rclpy.node import Node
from turtlesim.msg import Pose
from geometry_msgs.msg import Twist
from math import pow, atan2, sqrt, pi


class TurtleBot(Node):

    def __init__(self):
        super().__init__('turtlebot_controller')
        self.velocity_publisher = self.create_publisher(Twist, '/turtle1/cmd_vel', 10)
        self.pose_subscriber = self.create_subscription(Pose, '/turtle1/pose', self.update_pose, 10)
        self.pose = None

    def update_pose(self, data):
        self.pose = data
        self.pose.x = round(self.pose.x, 4)
        self.pose.y = round(self.pose.y, 4)

    def euclidean_distance(self, goal_pose):
        return sqrt(pow((goal_pose.x - self.pose.x), 2) + pow((goal_pose.y - self.pose.y), 2))

    def linear_vel(self, goal_pose, constant=1.5):
        return constant * self.euclidean_distance(goal_pose)

    def angular_vel(self, goal_pose, constant=6):
        error = atan2(goal_pose.y - self.pose.y, goal_pose.x - self.pose.x) - self.pose.theta
        if error > pi:
            error -= 2 * pi
        elif error < -pi:
            error += 2 * pi
        return constant * error

    def move2goal(self, x, y, distance_tolerance=0.1):
        goal_pose = Pose()
        goal_pose.x = x
        goal_pose.y = y
        while self.pose is None:
            rclpy.spin_once(self)
        vel_msg = Twist()
        while self.euclidean_distance(goal_pose) >= distance_tolerance:
            vel_msg.linear.x = self.linear_vel(goal_pose)
            vel_msg.angular.z = self.angular_vel(goal_pose)
            self.velocity_publisher.publish(vel_msg)
            rclpy.spin_once(self)
        vel_msg.linear.x = 0.0
        vel_msg.angular.z = 0.0
        self.velocity_publisher.publish(vel_msg)
        self.get_logger().info('Arrived at (%.1f, %.1f)' % (x, y))


def main():
    rclpy.init()
    x = TurtleBot()
    x.move2goal(2.0, 9.0)
    x.move2goal(9.0, 8.0)
    rclpy.spin_once(x, timeout_sec=0.5)
    x.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
