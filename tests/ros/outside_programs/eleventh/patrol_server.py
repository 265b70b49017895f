import math
import threading

import rclpy
from course_interfaces.action import Patrol
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.action import ActionServer, CancelResponse
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from tf_transformations import euler_from_quaternion


class PatrolServer(Node):
    def __init__(self):
        super().__init__('patrol_server')
        self.pose = None
        self.fresh = threading.Event()
        self.pub = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(Odometry, 'odom', self.on_odom, 10, callback_group=MutuallyExclusiveCallbackGroup())
        self.server = ActionServer(
            self, Patrol, 'patrol', self.execute, callback_group=ReentrantCallbackGroup(),
            cancel_callback=lambda goal: CancelResponse.ACCEPT)
        self.rate = self.create_rate(20)

    def on_odom(self, msg):
        q = msg.pose.pose.orientation
        yaw = euler_from_quaternion([q.x, q.y, q.z, q.w])[2]
        self.pose = (msg.pose.pose.position.x, msg.pose.pose.position.y, yaw)
        self.fresh.set()

    def execute(self, goal_handle):
        self.fresh.wait()
        goals = goal_handle.request.goals.poses
        feedback = Patrol.Feedback()
        for index, pose in enumerate(goals):
            while rclpy.ok():
                x, y, yaw = self.pose
                dx, dy = pose.position.x - x, pose.position.y - y
                left = math.hypot(dx, dy)
                if left < 0.1:
                    break
                if goal_handle.is_cancel_requested:
                    self.pub.publish(Twist())
                    goal_handle.canceled()
                    return Patrol.Result(missed=range(index, len(goals)))
                feedback.current, feedback.distance_remaining = index, left
                goal_handle.publish_feedback(feedback)
                turn = math.remainder(math.atan2(dy, dx) - yaw, math.tau)
                cmd = Twist()
                cmd.angular.z = max(-1.0, min(1.0, 2.0 * turn))
                cmd.linear.x = 0.4 if abs(turn) < 0.3 else 0.0
                self.pub.publish(cmd)
                self.rate.sleep()
        self.pub.publish(Twist())
        goal_handle.succeed()
        return Patrol.Result(missed=[])


def main():
    rclpy.init()
    node = PatrolServer()
    executor = MultiThreadedExecutor()
    executor.add_node(node)
    try:
        executor.spin()
    finally:
        node.destroy_node()


if __name__ == '__main__':
    main()
