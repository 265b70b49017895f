#!/usr/bin/env python3
import rclpy
from rclpy.node import Node
from rclpy.action import ActionClient
from rclpy.action.client import ClientGoalHandle, GoalStatus
from turtlesim.action import RotateAbsolute


class Rotator(Node):
    def __init__(self):
        super().__init__('rotator')
        self.client = ActionClient(self, RotateAbsolute, '/turtle1/rotate_absolute')
        self.angles = [1.5, -1.0, 1.9]
        self.feedbacks = 0
        self.finished = False

    def next(self):
        theta = self.angles.pop(0)
        self.client.wait_for_server()
        goal = RotateAbsolute.Goal()
        goal.theta = theta
        self.client.send_goal_async(goal, feedback_callback=self.on_feedback) \
            .add_done_callback(self.on_response)

    def on_response(self, future):
        handle: ClientGoalHandle = future.result()
        if not handle.accepted:
            self.get_logger().error('Goal rejected')
            return
        handle.get_result_async().add_done_callback(self.on_result)

    def on_feedback(self, msg):
        self.feedbacks += 1
        self.get_logger().debug(f'remaining {msg.feedback.remaining}')

    def on_result(self, future):
        status = future.result().status
        result = future.result().result
        if status == GoalStatus.STATUS_SUCCEEDED:
            self.get_logger().info(f'rotated by {-result.delta:.1f}')
        else:
            self.get_logger().warn(f'status {status}')
        if self.angles:
            self.next()
        else:
            self.get_logger().info('feedback received' if self.feedbacks else 'no feedback')
            self.finished = True


def main(args=None):
    rclpy.init(args=args)
    node = Rotator()
    node.next()
    while rclpy.ok() and not node.finished:
        rclpy.spin_once(node)
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
