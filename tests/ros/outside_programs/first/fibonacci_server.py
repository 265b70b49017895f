#!/usr/bin/env python3
import time
import rclpy
from rclpy.action import ActionServer
from rclpy.action.server import ServerGoalHandle, GoalResponse
from rclpy.node import Node
from action_tutorials_interfaces.action import Fibonacci


class FibonacciServer(Node):
    def __init__(self):
        super().__init__('fibonacci_server')
        self.server = ActionServer(self, Fibonacci, 'fibonacci',
                                   execute_callback=self.execute,
                                   goal_callback=self.check)

    def check(self, goal_request):
        # 46 fits in 32 bits
        return GoalResponse.ACCEPT if 0 < goal_request.order <= 45 else GoalResponse.REJECT

    def execute(self, handle: ServerGoalHandle):
        fb = Fibonacci.Feedback()
        fb.partial_sequence = [0, 1]
        for i in range(1, handle.request.order):
            fb.partial_sequence.append(fb.partial_sequence[i] + fb.partial_sequence[i - 1])
            handle.publish_feedback(fb)
            time.sleep(1)
        handle.succeed()
        res = Fibonacci.Result()
        res.sequence = fb.partial_sequence
        return res


rclpy.init()
rclpy.spin(FibonacciServer())
