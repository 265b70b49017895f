"""An action server that keeps to the newest goal, and a client that changes its mind."""

import threading
import time

import rclpy
from action_msgs.msg import GoalStatus
from example_interfaces.action import Fibonacci
from rclpy.action import ActionClient, ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node

NAMES = {
    GoalStatus.STATUS_SUCCEEDED: "succeeded",
    GoalStatus.STATUS_ABORTED: "aborted",
    GoalStatus.STATUS_CANCELED: "canceled",
}


class NewestGoalServer(Node):
    def __init__(self):
        super().__init__("newest_goal_server")
        self._goal_handle = None
        self._goal_lock = threading.Lock()
        self._server = ActionServer(
            self,
            Fibonacci,
            "fibonacci",
            execute_callback=self.execute_callback,
            goal_callback=self.goal_callback,
            handle_accepted_callback=self.handle_accepted_callback,
            cancel_callback=self.cancel_callback,
            callback_group=ReentrantCallbackGroup(),
        )

    def goal_callback(self, goal_request):
        if goal_request.order > 40:
            return GoalResponse.REJECT
        return GoalResponse.ACCEPT

    def handle_accepted_callback(self, goal_handle):
        with self._goal_lock:
            if self._goal_handle is not None and self._goal_handle.is_active:
                self.get_logger().info("aborting the previous goal")
                self._goal_handle.abort()
            self._goal_handle = goal_handle
        goal_handle.execute()

    def cancel_callback(self, goal):
        return CancelResponse.ACCEPT

    def execute_callback(self, goal_handle):
        feedback = Fibonacci.Feedback()
        feedback.sequence = [0, 1]
        for i in range(1, goal_handle.request.order):
            if not goal_handle.is_active:
                self.get_logger().info(f"order {goal_handle.request.order} was aborted at {i}")
                return Fibonacci.Result()
            if goal_handle.is_cancel_requested:
                goal_handle.canceled()
                return Fibonacci.Result(sequence=feedback.sequence)
            feedback.sequence.append(feedback.sequence[i] + feedback.sequence[i - 1])
            goal_handle.publish_feedback(feedback)
            time.sleep(0.2)
        with self._goal_lock:
            if not goal_handle.is_active:
                return Fibonacci.Result()
            goal_handle.succeed()
        result = Fibonacci.Result()
        result.sequence = feedback.sequence
        return result


class Client(Node):
    def __init__(self):
        super().__init__("changes_its_mind")
        self.client = ActionClient(self, Fibonacci, "fibonacci", callback_group=ReentrantCallbackGroup())
        self.feedback = {}

    def send(self, order):
        def on_feedback(message):
            self.feedback[order] = self.feedback.get(order, 0) + 1

        event = threading.Event()
        future = self.client.send_goal_async(Fibonacci.Goal(order=order), feedback_callback=on_feedback)
        future.add_done_callback(lambda _: event.set())
        event.wait()
        return future.result()

    def outcome(self, handle):
        answer = handle.get_result()
        return NAMES.get(answer.status, answer.status), list(answer.result.sequence)


def main():
    rclpy.init()
    server, client = NewestGoalServer(), Client()
    executor = MultiThreadedExecutor(num_threads=6)
    executor.add_node(server)
    executor.add_node(client)
    spinner = threading.Thread(target=executor.spin, daemon=True)
    spinner.start()

    assert client.client.wait_for_server(timeout_sec=5.0)
    print("rejected:", not client.send(41).accepted)
    first = client.send(20)
    time.sleep(1.0)
    second = client.send(5)
    print("first:", *client.outcome(first))
    print("second:", *client.outcome(second))
    third = client.send(30)
    time.sleep(0.9)
    answer = third.cancel_goal()
    print("cancelling:", len(answer.goals_canceling))
    status, sequence = client.outcome(third)
    print("third:", status, len(sequence))
    print("feedback:", client.feedback[5], 4 <= client.feedback[20] <= 7, 30 in client.feedback)
    executor.shutdown()
    client.destroy_node()
    server.destroy_node()
    rclpy.try_shutdown()
    spinner.join(timeout=2.0)
    print("all told")


if __name__ == "__main__":
    main()
