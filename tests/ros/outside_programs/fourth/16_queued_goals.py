import collections
import threading
import time

import rclpy
from example_interfaces.action import Fibonacci
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node


class QueueServer(Node):
    """Goals wait in a queue; one is executed at a time."""

    def __init__(self):
        super().__init__("queue_server")
        self._queue = collections.deque()
        self._lock = threading.Lock()
        self._current = None
        self._server = ActionServer(
            self, Fibonacci, "fibonacci",
            handle_accepted_callback=self.accepted,
            execute_callback=self.execute,
            goal_callback=lambda goal: GoalResponse.REJECT if goal.order < 1 else GoalResponse.ACCEPT,
            cancel_callback=lambda handle: CancelResponse.ACCEPT,
            callback_group=ReentrantCallbackGroup())

    def destroy(self):
        self._server.destroy()
        super().destroy_node()

    def accepted(self, handle):
        with self._lock:
            if self._current is not None:
                self._queue.append(handle)
                self.get_logger().info(f"Goal {handle.request.order} put in the queue")
            else:
                self._current = handle
                self._current.execute()

    def execute(self, handle):
        try:
            self.get_logger().info(f"Executing {handle.request.order}")
            feedback = Fibonacci.Feedback()
            feedback.sequence = [0, 1]
            for i in range(1, handle.request.order):
                if not handle.is_active:
                    return Fibonacci.Result()
                if handle.is_cancel_requested:
                    handle.canceled()
                    self.get_logger().info("Goal canceled")
                    return Fibonacci.Result()
                feedback.sequence.append(feedback.sequence[i] + feedback.sequence[i - 1])
                handle.publish_feedback(feedback)
                time.sleep(0.5)
            handle.succeed()
            result = Fibonacci.Result()
            result.sequence = feedback.sequence
            return result
        finally:
            with self._lock:
                try:
                    self._current = self._queue.popleft()
                    self._current.execute()
                except IndexError:
                    self._current = None


def main(args=None):
    try:
        with rclpy.init(args=args):
            node = QueueServer()
            rclpy.spin(node, executor=MultiThreadedExecutor())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == "__main__":
    main()
