from concurrent.futures import ThreadPoolExecutor
import os

import rclpy
from rclpy.executors import Executor, ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class Talker(Node):
    def __init__(self, name, period):
        super().__init__(name)
        self.i = 0
        self.pub = self.create_publisher(String, "chatter", 10)
        self.tmr = self.create_timer(period, self.callback)

    def callback(self):
        msg = String(data=f"{self.get_name()} {self.i}")
        self.i += 1
        self.get_logger().info(f'Publishing: "{msg.data}"')
        self.pub.publish(msg)


class Listener(Node):
    def __init__(self):
        super().__init__("listener")
        self.heard = []
        self.sub = self.create_subscription(String, "chatter", self.hear, 10)

    def hear(self, msg):
        self.heard.append(msg.data)


class PriorityExecutor(Executor):
    """Executor that serves its high priority nodes at once and the others one at a time in a second thread."""

    def __init__(self):
        super().__init__()
        self.high = set()
        self.hi = ThreadPoolExecutor(max_workers=os.cpu_count() or 4)
        self.lo = ThreadPoolExecutor(max_workers=1)

    def add_high_priority_node(self, node):
        self.high.add(node)
        self.add_node(node)

    def spin_once(self, timeout_sec=None):
        try:
            handler, group, node = self.wait_for_ready_callbacks(timeout_sec=timeout_sec)
        except StopIteration:
            pass
        else:
            pool = self.hi if node in self.high else self.lo
            pool.submit(handler)


def main(args=None):
    try:
        with rclpy.init(args=args):
            listener, fast, slow = Listener(), Talker("fast", 0.5), Talker("slow", 1.0)
            executor = PriorityExecutor()
            executor.add_high_priority_node(listener)
            executor.add_node(fast)
            executor.add_node(slow)
            print(len(executor.get_nodes()), "nodes")
            try:
                while rclpy.ok() and len(listener.heard) < 12:
                    executor.spin_once(timeout_sec=1.0)
            finally:
                executor.shutdown()
            count = {name: sum(h.startswith(name) for h in listener.heard) for name in ("fast", "slow")}
            print("heard", count["fast"], count["slow"])
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


main()
