#!/usr/bin/env python3
# goal 1 is cancelled after 2 s; goal 2 is pre-empted by goal 3; goal 3 runs to its end
import time
import rclpy
from rclpy.action import ActionClient
from action_msgs.msg import GoalStatus
from example_interfaces.action import Fibonacci

NAMES = {GoalStatus.STATUS_SUCCEEDED: 'SUCCEEDED',
         GoalStatus.STATUS_CANCELED: 'CANCELED',
         GoalStatus.STATUS_ABORTED: 'ABORTED'}

rclpy.init()
node = rclpy.create_node('cancel_client')
client = ActionClient(node, Fibonacci, 'fibonacci')
client.wait_for_server()


def wait(future):
    rclpy.spin_until_future_complete(node, future)
    return future.result()


def spin_for(seconds):
    end = time.time() + seconds
    while time.time() < end:
        rclpy.spin_once(node, timeout_sec=0.1)


first = wait(client.send_goal_async(Fibonacci.Goal(order=20)))
spin_for(2.0)
answer = wait(first.cancel_goal_async())
print('goals cancelling:', len(answer.goals_canceling), flush=True)
print('first', NAMES[wait(first.get_result_async()).status], flush=True)

second = wait(client.send_goal_async(Fibonacci.Goal(order=20)))
spin_for(1.0)
third = wait(client.send_goal_async(Fibonacci.Goal(order=6)))
print('second', NAMES[wait(second.get_result_async()).status], flush=True)
r = wait(third.get_result_async())
print('third', NAMES[r.status], list(r.result.sequence), flush=True)
node.destroy_node()
rclpy.shutdown()
