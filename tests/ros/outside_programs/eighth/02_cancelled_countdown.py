"""One process with an action server and a client that cancels, is refused, and waits for a result."""

import time

import rclpy
from action_msgs.msg import GoalStatus
from example_interfaces.action import Fibonacci
from rclpy.action import ActionClient, ActionServer, CancelResponse, GoalResponse
from rclpy.action.server import ServerGoalHandle
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node


class Server(Node):
    def __init__(self):
        super().__init__("fibonacci_server")
        self.server = ActionServer(
            self,
            Fibonacci,
            "fibonacci",
            execute_callback=self.execute,
            goal_callback=self.on_goal,
            cancel_callback=self.on_cancel,
            callback_group=ReentrantCallbackGroup(),
        )

    def on_goal(self, goal):
        if goal.order < 0 or goal.order > 40:
            self.get_logger().info(f"refused {goal.order}")
            return GoalResponse.REJECT
        return GoalResponse.ACCEPT

    def on_cancel(self, handle):
        self.get_logger().info("asked to cancel")
        return CancelResponse.ACCEPT

    def execute(self, handle: ServerGoalHandle):
        feedback = Fibonacci.Feedback()
        feedback.sequence = [0, 1]
        for i in range(1, handle.request.order):
            if handle.is_cancel_requested:
                handle.canceled()
                return Fibonacci.Result(sequence=feedback.sequence)
            if i == 13:
                handle.abort()
                return Fibonacci.Result()
            feedback.sequence.append(feedback.sequence[i] + feedback.sequence[i - 1])
            handle.publish_feedback(feedback)
            time.sleep(0.2)
        handle.succeed()
        return Fibonacci.Result(sequence=feedback.sequence)


class Client(Node):
    def __init__(self):
        super().__init__("fibonacci_client")
        self.client = ActionClient(self, Fibonacci, "fibonacci")
        self.goals = [10, 5, 99, 30]
        self.seen = 0

    def send(self):
        if not self.goals:
            self.get_logger().info("all goals are done")
            rclpy.shutdown()
            return
        order = self.goals.pop(0)
        self.seen = 0
        self.order = order
        self.client.wait_for_server()
        self.get_logger().info(f"goal {order}")
        future = self.client.send_goal_async(Fibonacci.Goal(order=order), feedback_callback=self.on_feedback)
        future.add_done_callback(self.on_response)

    def on_response(self, future):
        self.goal_handle = future.result()
        if not self.goal_handle.accepted:
            self.get_logger().info(f"goal {self.order} was refused")
            self.send()
            return
        self.goal_handle.get_result_async().add_done_callback(self.on_result)

    def on_feedback(self, message):
        self.seen += 1
        if self.order == 10 and self.seen == 4:
            self.goal_handle.cancel_goal_async().add_done_callback(self.on_cancelled)

    def on_cancelled(self, future):
        self.get_logger().info(f"cancelling: {len(future.result().goals_canceling)} goals")

    def on_result(self, future):
        status = future.result().status
        names = {
            GoalStatus.STATUS_SUCCEEDED: "succeeded",
            GoalStatus.STATUS_CANCELED: "canceled",
            GoalStatus.STATUS_ABORTED: "aborted",
        }
        sequence = list(future.result().result.sequence)
        self.get_logger().info(f"goal {self.order} {names[status]}: {sequence}")
        self.send()


def main(args=None):
    rclpy.init(args=args)
    server, client = Server(), Client()
    executor = MultiThreadedExecutor(num_threads=4)
    executor.add_node(server)
    executor.add_node(client)
    first = client.create_timer(0.1, lambda: (first.cancel(), client.send()))
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        executor.shutdown()
        print("bye")


if __name__ == "__main__":
    main()
