"""Slow services in exclusive and reentrant groups: which of them overlap, measured by how many run at once."""

import threading
import time

import rclpy
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node
from std_srvs.srv import Trigger


class Workshop(Node):
    def __init__(self):
        super().__init__("workshop")
        self.lock = threading.Lock()
        self.running = {"single": 0, "many": 0}
        self.most = {"single": 0, "many": 0}
        self.create_service(Trigger, "single", self.make("single"), callback_group=MutuallyExclusiveCallbackGroup())
        self.create_service(Trigger, "many", self.make("many"), callback_group=ReentrantCallbackGroup())

    def make(self, name):
        def work(request, response):
            with self.lock:
                self.running[name] += 1
                self.most[name] = max(self.most[name], self.running[name])
            time.sleep(0.5)
            with self.lock:
                self.running[name] -= 1
            response.success = True
            response.message = name
            return response

        return work


class Customer(Node):
    def __init__(self, workshop):
        super().__init__("customer")
        self.workshop = workshop
        group = ReentrantCallbackGroup()
        self.single = self.create_client(Trigger, "single", callback_group=group)
        self.many = self.create_client(Trigger, "many", callback_group=group)
        self.ticks = 0
        self.create_timer(0.1, self.tick, callback_group=MutuallyExclusiveCallbackGroup())
        self.once = self.create_timer(0.2, self.shop, callback_group=MutuallyExclusiveCallbackGroup())

    def tick(self):
        self.ticks += 1

    def seconds(self):
        return self.get_clock().now().nanoseconds / 1e9

    def shop(self):
        self.once.cancel()
        for name, client in (("single", self.single), ("many", self.many)):
            client.wait_for_service()
            start = self.seconds()
            futures = [client.call_async(Trigger.Request()) for _ in range(3)]
            while not all(each.done() for each in futures):
                time.sleep(0.01)
            took = self.seconds() - start
            self.get_logger().info(f"{name}: {took:.1f} s, at once {self.workshop.most[name]}")
        answer = self.single.call(Trigger.Request())
        self.get_logger().info(f"blocking call: {answer.success} {answer.message}")
        self.get_logger().info(f"ticks went on: {self.ticks > 20}")
        rclpy.shutdown()


def main():
    rclpy.init()
    workshop = Workshop()
    executor = MultiThreadedExecutor(num_threads=8)
    executor.add_node(workshop)
    executor.add_node(Customer(workshop))
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    print("closed")


if __name__ == "__main__":
    main()
