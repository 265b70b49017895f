#!/usr/bin/env python3
import sys
import math

import rclpy
from rclpy.node import Node
from nav_msgs.msg import Odometry
from geometry_msgs.msg import Twist, Point


def yaw_of(q):
    return math.atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y ** 2 + q.z ** 2))


def wrap(a):
    return (a + math.pi) % (2 * math.pi) - math.pi


class GoToGoal(Node):

    def __init__(self, goal: Point):
        super().__init__('go_to_goal')
        self.goal = goal
        self.pose = None
        self.finished = False
        self.pub = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(Odometry, 'odom', self.odom_cb, 10)

    def odom_cb(self, msg: Odometry):
        p = msg.pose.pose.position
        yaw = yaw_of(msg.pose.pose.orientation)
        dx, dy = self.goal.x - p.x, self.goal.y - p.y
        rho = math.hypot(dx, dy)
        alpha = wrap(math.atan2(dy, dx) - yaw)
        cmd = Twist()
        if rho < 0.1:
            self.finished = True
        else:
            cmd.angular.z = max(-0.8, min(0.8, 1.5 * alpha))
            if abs(alpha) < 0.5:
                cmd.linear.x = min(0.4, 0.6 * rho)
        self.pub.publish(cmd)


def main():
    rclpy.init(args=sys.argv)
    goal = Point()
    goal.x = float(sys.argv[1])
    goal.y = float(sys.argv[2])
    node = GoToGoal(goal)
    node.get_logger().info(f'goal: ({goal.x}, {goal.y})')
    while rclpy.ok() and not node.finished:
        rclpy.spin_once(node)
    node.get_logger().info('Goal reached!')
    for _ in range(5):
        node.pub.publish(Twist())
        rclpy.spin_once(node, timeout_sec=0.1)
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
