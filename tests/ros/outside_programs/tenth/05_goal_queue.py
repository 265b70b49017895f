"""An action server that queues accepted goals and runs one after another (handle_accepted_callback).

Meant: three goals sent together run in order, none beside another; the third is cancelled while it
still waits and ends as canceled with an empty sequence; one with a negative order is rejected.
"""
import collections
import threading
import time

import rclpy
from action_msgs.msg import GoalStatus
from example_interfaces.action import Fibonacci
from rclpy.action import ActionClient, ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node


class QueueServer(Node):
    def __init__(self):
        super().__init__('queue_server')
        self._queue = collections.deque()
        self._lock = threading.Lock()
        self._current = None
        self._beside = 0
        self._server = ActionServer(
            self, Fibonacci, 'fibonacci',
            handle_accepted_callback=self.accepted,
            execute_callback=self.execute,
            goal_callback=self.goal,
            cancel_callback=self.cancel,
            callback_group=ReentrantCallbackGroup())

    def destroy(self):
        self._server.destroy()
        super().destroy_node()

    def goal(self, request):
        return GoalResponse.REJECT if request.order < 0 else GoalResponse.ACCEPT

    def cancel(self, handle):
        self.get_logger().info(f'asked to cancel order {handle.request.order}')
        return CancelResponse.ACCEPT

    def accepted(self, handle):
        with self._lock:
            if self._current is not None:
                self._queue.append(handle)
                self.get_logger().info(f'order {handle.request.order} waits')
            else:
                self._current = handle
                handle.execute()

    def execute(self, handle):
        try:
            self._beside += 1
            assert self._beside == 1, 'two at once'
            result = Fibonacci.Result()
            if handle.is_cancel_requested:
                handle.canceled()
                return result
            feedback = Fibonacci.Feedback()
            feedback.sequence = [0, 1]
            for i in range(1, handle.request.order):
                if handle.is_cancel_requested:
                    handle.canceled()
                    return result
                feedback.sequence.append(feedback.sequence[i] + feedback.sequence[i - 1])
                handle.publish_feedback(feedback)
                time.sleep(0.2)
            handle.succeed()
            result.sequence = feedback.sequence
            return result
        finally:
            self._beside -= 1
            with self._lock:
                self._current = self._queue.popleft() if self._queue else None
                if self._current is not None:
                    self._current.execute()


class Customer(Node):
    def __init__(self):
        super().__init__('customer')
        self.client = ActionClient(self, Fibonacci, 'fibonacci')
        self.ends = []
        self.feedback = collections.Counter()

    def order(self, n):
        goal = Fibonacci.Goal(order=n)
        future = self.client.send_goal_async(
            goal, feedback_callback=lambda message, n=n: self.feedback.update([n]))
        future.add_done_callback(lambda f, n=n: self.answered(n, f.result()))

    def answered(self, n, handle):
        if not handle.accepted:
            self.get_logger().info(f'order {n} rejected')
            return
        if n == 4:
            handle.cancel_goal_async().add_done_callback(
                lambda f: self.get_logger().info(f'cancelling: {len(f.result().goals_canceling)}'))
        handle.get_result_async().add_done_callback(lambda f, n=n: self.ended(n, f.result()))

    def ended(self, n, response):
        names = {GoalStatus.STATUS_SUCCEEDED: 'succeeded', GoalStatus.STATUS_CANCELED: 'canceled'}
        self.get_logger().info(
            f'order {n} {names[response.status]} {list(response.result.sequence)}')
        self.ends.append(n)
        if len(self.ends) == 3:
            print('ends', self.ends, 'feedback', dict(sorted(self.feedback.items())))


def main():
    rclpy.init()
    server, customer = QueueServer(), Customer()
    executor = MultiThreadedExecutor(num_threads=4)
    executor.add_node(server)
    executor.add_node(customer)
    customer.client.wait_for_server()
    for n in (5, 3, 4, -1):
        customer.order(n)
    while rclpy.ok() and len(customer.ends) < 3:
        executor.spin_once(timeout_sec=0.5)
    server.destroy()
    customer.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
