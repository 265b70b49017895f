import math

import rclpy
from action_msgs.msg import GoalStatus
from rclpy.action import ActionClient
from rclpy.node import Node
from turtlesim.action import RotateAbsolute
from turtlesim.msg import Pose


class Rotator(Node):
    def __init__(self):
        super().__init__("rotator")
        self.client = ActionClient(self, RotateAbsolute, "turtle1/rotate_absolute")
        self.theta = None
        self.remaining = []
        self.create_subscription(Pose, "turtle1/pose", self.on_pose, 10)
        self.done = rclpy.task.Future()

    def on_pose(self, pose):
        self.theta = pose.theta

    def start(self):
        self.client.wait_for_server()
        goal = RotateAbsolute.Goal()
        goal.theta = 3.0
        future = self.client.send_goal_async(goal, feedback_callback=self.on_feedback)
        future.add_done_callback(self.on_response)

    def on_response(self, future):
        self.goal_handle = future.result()
        self.get_logger().info(f"accepted: {self.goal_handle.accepted}")
        self.goal_handle.get_result_async().add_done_callback(self.on_result)
        self.timer = self.create_timer(1.0, self.cancel)

    def on_feedback(self, message):
        self.remaining.append(message.feedback.remaining)

    def cancel(self):
        self.timer.cancel()
        self.goal_handle.cancel_goal_async().add_done_callback(self.on_cancel)

    def on_cancel(self, future):
        response = future.result()
        print("cancelling", len(response.goals_canceling))

    def on_result(self, future):
        status = future.result().status
        names = {GoalStatus.STATUS_CANCELED: "canceled", GoalStatus.STATUS_SUCCEEDED: "succeeded"}
        print("status", names.get(status, status), f"turned {future.result().result.delta:.1f}")
        self.done.set_result(self.theta)


def main():
    rclpy.init()
    node = Rotator()
    node.start()
    theta = None
    rclpy.spin_until_future_complete(node, node.done, timeout_sec=10)
    theta = node.done.result()
    print("feedback falls:", node.remaining[0] > node.remaining[-1], len(node.remaining) > 20)
    print("half way:", 0.5 < theta < 2.0, math.isfinite(theta))
    node.destroy_node()
    rclpy.shutdown()


main()
