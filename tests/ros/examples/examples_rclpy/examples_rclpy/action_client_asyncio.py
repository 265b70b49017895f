"""An action client whose goals are awaited in a loop of asyncio, beside a task that spins."""

import asyncio

import rclpy
from action_msgs.msg import GoalStatus
from example_interfaces.action import Fibonacci
from rclpy.action import ActionClient
from rclpy.node import Node


class MinimalActionClient(Node):
    def __init__(self):
        super().__init__("minimal_action_client")
        self._action_client = ActionClient(self, Fibonacci, "fibonacci")

    def feedback_callback(self, feedback):
        self.get_logger().info("Received feedback: {0}".format(feedback.feedback.sequence))

    async def send_goal(self, order):
        self._action_client.wait_for_server()
        goal_msg = Fibonacci.Goal()
        goal_msg.order = order
        goal_handle = await self._action_client.send_goal_async(
            goal_msg, feedback_callback=self.feedback_callback
        )
        if not goal_handle.accepted:
            self.get_logger().info("Goal rejected :(")
            return None
        res = await goal_handle.get_result_async()
        if res.status == GoalStatus.STATUS_SUCCEEDED:
            self.get_logger().info("Goal succeeded! Result: {0}".format(res.result.sequence))
        return res.result, res.status


async def spinning(node):
    while rclpy.ok():
        rclpy.spin_once(node, timeout_sec=0.01)
        await asyncio.sleep(0.001)


async def run(args, loop):
    rclpy.init(args=args)
    action_client = MinimalActionClient()
    spin_task = loop.create_task(spinning(action_client))
    tasks = [loop.create_task(action_client.send_goal(order)) for order in (3, 4)]
    finished, unfinished = await asyncio.wait(tasks)
    print("unfinished:", len(unfinished), "finished:", len(finished))
    result, status = await loop.create_task(action_client.send_goal(2))
    print("A) result {} and status flag {}".format(result.sequence, status))
    spin_task.cancel()
    try:
        await spin_task
    except asyncio.exceptions.CancelledError:
        pass
    rclpy.shutdown()


def main(args=None):
    loop = asyncio.new_event_loop()
    loop.run_until_complete(run(args, loop))


if __name__ == "__main__":
    main()
