"""An executor of the program's own: callbacks of some nodes run in many threads, all others in one."""

import os
from concurrent.futures import ThreadPoolExecutor

import rclpy
from rclpy.executors import Executor
from rclpy.node import Node
from std_msgs.msg import String

from examples_rclpy.listener import Listener
from examples_rclpy.talker import Talker


class Estopper(Node):
    def __init__(self):
        super().__init__("estopper")
        self.sub = self.create_subscription(String, "estop", self.estop_callback, 10)

    def estop_callback(self, msg):
        self.get_logger().info(f"I heard: {msg.data}")


class PriorityExecutor(Executor):
    def __init__(self):
        super().__init__()
        self.high_priority_nodes = set()
        self.hp_executor = ThreadPoolExecutor(max_workers=os.cpu_count() or 4)
        self.lp_executor = ThreadPoolExecutor(max_workers=1)

    def add_high_priority_node(self, node):
        self.high_priority_nodes.add(node)
        self.add_node(node)

    def spin_once(self, timeout_sec=None):
        try:
            handler, group, node = self.wait_for_ready_callbacks(timeout_sec=timeout_sec)
        except StopIteration:
            pass
        else:
            if node in self.high_priority_nodes:
                self.hp_executor.submit(handler)
            else:
                self.lp_executor.submit(handler)


def main(args=None):
    rclpy.init(args=args)
    try:
        executor = PriorityExecutor()
        executor.add_high_priority_node(Estopper())
        executor.add_node(Listener())
        executor.add_node(Talker())
        try:
            executor.spin()
        finally:
            executor.shutdown()
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
