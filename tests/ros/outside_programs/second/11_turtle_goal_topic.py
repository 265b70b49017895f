#!/usr/bin/env python3
"""goals come as geometry_msgs/Point on /goal and are queued; after each the distance swum is published"""
import math
import queue
import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Point, Twist
from std_msgs.msg import Empty, Float32
from turtlesim.msg import Pose


class GoalQueue(Node):
    def __init__(self):
        super().__init__('goal_queue')
        self.goals = queue.Queue()
        self.goal = None
        self.pose = None
        self.swum = 0.0
        self.create_subscription(Point, 'goal', lambda p: self.goals.put((p.x, p.y)), 10)
        self.create_subscription(Empty, 'cancel_all', self.cancel, 10)
        self.create_subscription(Pose, 'turtle1/pose', self.on_pose, 10)
        self.cmd = self.create_publisher(Twist, 'turtle1/cmd_vel', 10)
        self.dist = self.create_publisher(Float32, 'distance_swum', 10)
        self.create_timer(0.05, self.control)

    def cancel(self, _):
        n = self.goals.qsize()
        while not self.goals.empty():
            self.goals.get()
        self.goal = None
        self.cmd.publish(Twist())
        self.get_logger().info(f'cancelled, {n} were waiting')

    def on_pose(self, p):
        if self.pose is not None:
            self.swum += math.hypot(p.x - self.pose.x, p.y - self.pose.y)
        self.pose = p

    def control(self):
        if self.pose is None:
            return
        if self.goal is None:
            try:
                self.goal = self.goals.get_nowait()
            except queue.Empty:
                return
        dx, dy = self.goal[0] - self.pose.x, self.goal[1] - self.pose.y
        d = math.hypot(dx, dy)
        t = Twist()
        if d < 0.1:
            self.get_logger().info('at (%.0f, %.0f)' % self.goal)
            self.dist.publish(Float32(data=self.swum))
            self.goal = None
        else:
            e = math.remainder(math.atan2(dy, dx) - self.pose.theta, math.tau)
            t.linear.x = min(2.0, 2.0 * d) * max(0.0, math.cos(e))
            t.angular.z = 4.0 * e
        self.cmd.publish(t)


def main():
    rclpy.init()
    rclpy.spin(GoalQueue())


if __name__ == '__main__':
    main()
