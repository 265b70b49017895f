import time

import rclpy
from course_interfaces.action import CountUntil
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node


class CountServer(Node):
    def __init__(self):
        super().__init__("count_server")
        self.server = ActionServer(
            self,
            CountUntil,
            "count_until",
            goal_callback=self.on_goal,
            cancel_callback=lambda goal: CancelResponse.ACCEPT,
            execute_callback=self.execute,
            callback_group=ReentrantCallbackGroup(),
        )

    def on_goal(self, goal):
        return GoalResponse.ACCEPT if goal.target > 0 else GoalResponse.REJECT

    def execute(self, goal_handle):
        result = CountUntil.Result()
        for number in range(1, goal_handle.request.target + 1):
            if goal_handle.is_cancel_requested:
                goal_handle.canceled()
                return result
            result.reached = number
            feedback = CountUntil.Feedback()
            feedback.current = number
            goal_handle.publish_feedback(feedback)
            time.sleep(goal_handle.request.period)
        goal_handle.succeed()
        return result


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(CountServer(), executor=MultiThreadedExecutor())


if __name__ == "__main__":
    main()
