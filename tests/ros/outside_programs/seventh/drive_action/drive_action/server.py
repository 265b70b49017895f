import math
import time

import rclpy
from drive_interfaces.action import DriveDistance
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.action.server import ServerGoalHandle
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node


class Server(Node):
    def __init__(self):
        super().__init__('drive_server')
        group = ReentrantCallbackGroup()
        self.at = None
        self.cmd = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(Odometry, 'odom', self.on_odom, 10, callback_group=group)
        self.goal_handle = None
        self.server = ActionServer(
            self, DriveDistance, 'drive_distance', execute_callback=self.execute,
            goal_callback=self.on_goal, handle_accepted_callback=self.on_accepted,
            cancel_callback=self.on_cancel, callback_group=group, result_timeout=60)

    def on_odom(self, msg):
        self.at = msg.pose.pose.position

    def on_goal(self, goal):
        if abs(goal.distance) > 5 or goal.speed <= 0:
            self.get_logger().warn(f'rejected: {goal.distance:g} m at {goal.speed:g} m/s')
            return GoalResponse.REJECT
        return GoalResponse.ACCEPT

    def on_accepted(self, handle: ServerGoalHandle):
        if self.goal_handle is not None and self.goal_handle.is_active:
            self.get_logger().info('a new goal takes the place of the old one')
            self.goal_handle.abort()
        self.goal_handle = handle
        handle.execute()

    def on_cancel(self, handle):
        self.get_logger().info('cancel asked')
        return CancelResponse.ACCEPT

    def execute(self, handle):
        goal = handle.request
        while self.at is None:
            time.sleep(0.05)
        start = self.at
        feedback = DriveDistance.Feedback()
        command = Twist()
        command.linear.x = math.copysign(goal.speed, goal.distance)
        result = DriveDistance.Result()
        while True:
            result.driven = math.hypot(self.at.x - start.x, self.at.y - start.y)
            feedback.remaining = abs(goal.distance) - result.driven
            if not handle.is_active:
                return result
            if handle.is_cancel_requested:
                self.cmd.publish(Twist())
                handle.canceled()
                return result
            if feedback.remaining <= 0.0:
                break
            handle.publish_feedback(feedback)
            self.cmd.publish(command)
            time.sleep(0.1)
        self.cmd.publish(Twist())
        result.complete = True
        handle.succeed()
        return result

    def destroy_node(self):
        self.server.destroy()
        super().destroy_node()


def main(args=None):
    rclpy.init(args=args)
    server = Server()
    rclpy.spin(server, executor=MultiThreadedExecutor())
    server.destroy_node()
    rclpy.shutdown()
