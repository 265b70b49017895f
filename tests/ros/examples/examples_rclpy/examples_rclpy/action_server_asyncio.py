"""An action server whose execute callback runs a loop of asyncio of its own."""

import asyncio

import rclpy
from example_interfaces.action import Fibonacci
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node


def asyncio_loop(func):
    def wrapper(*args, **kwargs):
        return asyncio.new_event_loop().run_until_complete(func(*args, **kwargs))

    return wrapper


class MinimalActionServer(Node):
    def __init__(self):
        super().__init__("minimal_action_server_asyncio")
        self._action_server = ActionServer(
            self,
            Fibonacci,
            "fibonacci",
            execute_callback=self.execute_callback,
            callback_group=ReentrantCallbackGroup(),
            goal_callback=lambda goal_request: GoalResponse.ACCEPT,
            cancel_callback=lambda goal_handle: CancelResponse.ACCEPT,
        )

    def destroy(self):
        self._action_server.destroy()
        super().destroy_node()

    @asyncio_loop
    async def execute_callback(self, goal_handle):
        self.get_logger().info("Executing goal...")
        feedback_msg = Fibonacci.Feedback()
        feedback_msg.sequence = [0, 1]
        for i in range(1, goal_handle.request.order):
            if goal_handle.is_cancel_requested:
                goal_handle.canceled()
                self.get_logger().info("Goal canceled")
                return Fibonacci.Result()
            feedback_msg.sequence.append(feedback_msg.sequence[i] + feedback_msg.sequence[i - 1])
            self.get_logger().info("Publishing feedback: {0}".format(feedback_msg.sequence))
            goal_handle.publish_feedback(feedback_msg)
            await asyncio.sleep(0.05)
        goal_handle.succeed()
        result = Fibonacci.Result()
        result.sequence = feedback_msg.sequence
        self.get_logger().info("Returning result: {0}".format(result.sequence))
        return result


def main(args=None):
    rclpy.init(args=args)
    try:
        action_server = MinimalActionServer()
        executor = MultiThreadedExecutor()
        rclpy.spin(action_server, executor=executor)
        action_server.destroy()
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
