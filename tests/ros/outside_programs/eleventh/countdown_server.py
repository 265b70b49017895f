import threading
import time

import rclpy
from course_interfaces.action import CountDown
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.action.server import ServerGoalHandle
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node


class CountDownServer(Node):
    def __init__(self):
        super().__init__('count_down_server')
        self.goal_handle: ServerGoalHandle | None = None
        self.lock = threading.Lock()
        self.server = ActionServer(
            self, CountDown, 'count_down', execute_callback=self.execute,
            goal_callback=self.on_goal, handle_accepted_callback=self.on_accepted,
            cancel_callback=self.on_cancel, callback_group=ReentrantCallbackGroup())

    def on_goal(self, goal: CountDown.Goal) -> GoalResponse:
        if goal.start <= 0:
            self.get_logger().warn(f'rejected {goal.start}')
            return GoalResponse.REJECT
        return GoalResponse.ACCEPT

    def on_accepted(self, goal_handle):
        with self.lock:
            if self.goal_handle is not None and self.goal_handle.is_active:
                self.get_logger().info('Aborting previous goal')
                self.goal_handle.abort()
            self.goal_handle = goal_handle
        goal_handle.execute()

    def on_cancel(self, goal_handle) -> CancelResponse:
        return CancelResponse.ACCEPT

    def execute(self, goal_handle):
        remaining = goal_handle.request.start
        feedback = CountDown.Feedback()
        while remaining >= 0:
            if not goal_handle.is_active:
                return CountDown.Result(reached=remaining + 1)
            if goal_handle.is_cancel_requested:
                goal_handle.canceled()
                return CountDown.Result(reached=remaining + 1)
            feedback.remaining = remaining
            goal_handle.publish_feedback(feedback)
            remaining -= 1
            time.sleep(goal_handle.request.period)
        with self.lock:
            if not goal_handle.is_active:
                return CountDown.Result(reached=0)
            goal_handle.succeed()
        return CountDown.Result(reached=0)

    def destroy_node(self):
        self.server.destroy()
        super().destroy_node()


def main():
    rclpy.init()
    node = CountDownServer()
    try:
        rclpy.spin(node, executor=MultiThreadedExecutor())
    except KeyboardInterrupt:
        pass


if __name__ == '__main__':
    main()
