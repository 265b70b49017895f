"""Callback groups: a service called from within a timer callback works in a reentrant group; exclusive timers exclude."""
import threading
import time
import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node


class N(Node):
    def __init__(self):
        super().__init__("groups")
        self.client_group = MutuallyExclusiveCallbackGroup()
        self.srv = self.create_service(AddTwoInts, "add", self.add, callback_group=ReentrantCallbackGroup())
        self.cli = self.create_client(AddTwoInts, "add", callback_group=self.client_group)
        self.timer = self.create_timer(0.2, self.tick, callback_group=MutuallyExclusiveCallbackGroup())
        ex = MutuallyExclusiveCallbackGroup()
        self.inside = 0
        self.most = 0
        self.a = self.create_timer(0.05, self.slow, callback_group=ex)
        self.b = self.create_timer(0.05, self.slow, callback_group=ex)
        self.n = 0
        self.lock = threading.Lock()

    def slow(self):
        with self.lock:
            self.inside += 1
            self.most = max(self.most, self.inside)
        time.sleep(0.03)
        with self.lock:
            self.inside -= 1

    def add(self, req, res):
        time.sleep(0.05)
        res.sum = req.a + req.b
        return res

    def tick(self):
        self.n += 1
        r = self.cli.call(AddTwoInts.Request(a=self.n, b=10))
        self.get_logger().info(f"{self.n} + 10 = {r.sum}, at most {self.most} inside")
        if self.n == 4:
            rclpy.shutdown()


def main():
    rclpy.init()
    n = N()
    e = MultiThreadedExecutor()
    e.add_node(n)
    try:
        e.spin()
    finally:
        n.destroy_node()


main()
