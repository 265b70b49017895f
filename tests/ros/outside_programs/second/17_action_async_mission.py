#!/usr/bin/env python3
# a mission as one coroutine given to the executor, client and server nodes in one process
import rclpy
from rclpy.action import ActionClient, ActionServer, GoalResponse, CancelResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from action_msgs.msg import GoalStatus
from example_interfaces.action import Fibonacci


class Factory(Node):
    def __init__(self):
        super().__init__('factory')
        self.rate = self.create_rate(5)
        self.server = ActionServer(self, Fibonacci, 'make', self.execute,
                                   goal_callback=lambda g: GoalResponse.ACCEPT,
                                   cancel_callback=lambda h: CancelResponse.ACCEPT,
                                   callback_group=ReentrantCallbackGroup())

    def execute(self, handle):
        seq = [0, 1]
        while len(seq) <= handle.request.order:
            seq.append(seq[-1] + seq[-2])
            handle.publish_feedback(Fibonacci.Feedback(sequence=seq))
            self.rate.sleep()
        if handle.request.order % 2:
            handle.abort()
        else:
            handle.succeed()
        return Fibonacci.Result(sequence=seq)


class Customer(Node):
    def __init__(self):
        super().__init__('customer')
        self.client = ActionClient(self, Fibonacci, 'make', callback_group=ReentrantCallbackGroup())
        self.fb = 0

    def feedback(self, msg):
        self.fb += 1

    async def mission(self):
        self.client.wait_for_server()
        for order in (4, 5, 8):
            handle = await self.client.send_goal_async(Fibonacci.Goal(order=order), feedback_callback=self.feedback)
            response = await handle.get_result_async()
            good = response.status == GoalStatus.STATUS_SUCCEEDED
            self.get_logger().info(f'order {order}: {"made" if good else "failed"}, last is {response.result.sequence[-1]}')
        return self.fb


def main(args=None):
    rclpy.init(args=args)
    factory, customer = Factory(), Customer()
    executor = MultiThreadedExecutor(num_threads=4)
    executor.add_node(factory)
    executor.add_node(customer)
    task = executor.create_task(customer.mission)
    executor.spin_until_future_complete(task)
    print('some feedback' if task.result() >= 10 else 'hardly any feedback')
    executor.shutdown()
    factory.destroy_node()
    customer.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
