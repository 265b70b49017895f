"""An action server and a client in one process: a goal with feedback, one cancelled, one refused, one aborted."""
import time
import rclpy
from action_msgs.msg import GoalStatus
from example_interfaces.action import Fibonacci
from rclpy.action import ActionClient, ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node


class Server(Node):
    def __init__(self):
        super().__init__("fib_server")
        self.server = ActionServer(self, Fibonacci, "fibonacci", execute_callback=self.execute,
                                   goal_callback=self.goal, cancel_callback=lambda g: CancelResponse.ACCEPT,
                                   callback_group=ReentrantCallbackGroup())

    def goal(self, request):
        return GoalResponse.REJECT if request.order < 0 else GoalResponse.ACCEPT

    def execute(self, handle):
        seq = [0, 1]
        for i in range(1, handle.request.order):
            if handle.is_cancel_requested:
                handle.canceled()
                return Fibonacci.Result(sequence=seq)
            if i > 20:
                handle.abort()
                return Fibonacci.Result(sequence=seq[:3])
            seq.append(seq[-1] + seq[-2])
            handle.publish_feedback(Fibonacci.Feedback(sequence=seq))
            time.sleep(0.1)
        handle.succeed()
        return Fibonacci.Result(sequence=seq)


class Client(Node):
    def __init__(self):
        super().__init__("fib_client")
        self.client = ActionClient(self, Fibonacci, "fibonacci")

    async def goals(self):
        self.client.wait_for_server()
        self.feedback = 0
        h = await self.client.send_goal_async(Fibonacci.Goal(order=6), feedback_callback=self.on_feedback)
        r = await h.get_result_async()
        print("result", list(r.result.sequence), r.status == GoalStatus.STATUS_SUCCEEDED, "feedback", self.feedback)
        h = await self.client.send_goal_async(Fibonacci.Goal(order=-1))
        print("accepted", h.accepted)
        h = await self.client.send_goal_async(Fibonacci.Goal(order=18))
        self.t = self.create_timer(0.45, lambda: (self.t.cancel(), h.cancel_goal_async()))
        r = await h.get_result_async()
        print("cancelled", r.status == GoalStatus.STATUS_CANCELED, len(r.result.sequence) < 10)
        h = await self.client.send_goal_async(Fibonacci.Goal(order=40))
        r = await h.get_result_async()
        print("aborted", r.status == GoalStatus.STATUS_ABORTED, list(r.result.sequence))

    def on_feedback(self, msg):
        self.feedback += 1


def main():
    rclpy.init()
    ex = MultiThreadedExecutor(num_threads=4)
    s, c = Server(), Client()
    ex.add_node(s)
    ex.add_node(c)
    task = ex.create_task(c.goals())
    ex.spin_until_future_complete(task)
    print("done", task.done())
    ex.shutdown()
    rclpy.shutdown()


main()
