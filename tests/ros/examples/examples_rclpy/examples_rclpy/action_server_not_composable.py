"""An action server of functions only."""

import time

import rclpy
from example_interfaces.action import Fibonacci
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor

logger = None


def cancel_request_callback(goal_handle):
    logger.info("Got cancel request")
    return CancelResponse.ACCEPT


async def execute_callback(goal_handle):
    logger.info("Executing the goal...")
    feedback_msg = Fibonacci.Feedback()
    feedback_msg.sequence = [0, 1]
    for i in range(1, goal_handle.request.order):
        if goal_handle.is_cancel_requested:
            goal_handle.canceled()
            logger.info("Goal canceled")
            return Fibonacci.Result()
        feedback_msg.sequence.append(feedback_msg.sequence[i] + feedback_msg.sequence[i - 1])
        goal_handle.publish_feedback(feedback_msg)
        time.sleep(1)
    goal_handle.succeed()
    result = Fibonacci.Result()
    result.sequence = feedback_msg.sequence
    logger.info("Returning result: {0}".format(result.sequence))
    return result


def main(args=None):
    global logger
    rclpy.init(args=args)
    node = rclpy.create_node("minimal_action_server")
    logger = node.get_logger()
    # A group that lets the cancel callback run while the execute callback does.
    action_server = ActionServer(
        node,
        Fibonacci,
        "fibonacci",
        execute_callback=execute_callback,
        goal_callback=lambda goal_request: GoalResponse.ACCEPT,
        cancel_callback=cancel_request_callback,
        callback_group=ReentrantCallbackGroup(),
    )
    rclpy.spin(node, executor=MultiThreadedExecutor())
    action_server.destroy()
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
