import threading
import time

import rclpy
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.task import Future


class Demo(Node):
    def __init__(self, name, fast_group=None, slow_group=None, slow_period=0.5):
        super().__init__(name)
        self.fast = self.slow = self.inside = self.overlaps = 0
        self.lock = threading.Lock()
        self.fast_timer = self.create_timer(0.1, self.on_fast, callback_group=fast_group)
        self.slow_timer = self.create_timer(slow_period, self.on_slow, callback_group=slow_group)

    def on_fast(self):
        self.fast += 1

    def on_slow(self):
        with self.lock:
            self.inside += 1
            self.overlaps += self.inside > 1
        time.sleep(0.45)
        with self.lock:
            self.inside -= 1
            self.slow += 1


def run(node, executor, seconds=2.05):
    executor.add_node(node)
    end = node.get_clock().now() + rclpy.duration.Duration(seconds=seconds)
    while rclpy.ok() and node.get_clock().now() < end:
        executor.spin_once(timeout_sec=0.05)
    result = node.fast, node.slow, node.overlaps
    node.fast_timer.cancel()
    node.slow_timer.cancel()
    executor.shutdown(timeout_sec=1.0)
    node.destroy_node()
    return result


def main():
    rclpy.init()
    group = MutuallyExclusiveCallbackGroup()
    fast_1, slow_1, over_1 = run(Demo('single'), SingleThreadedExecutor())
    print('single fast', fast_1, 'slow', slow_1)
    fast_2, slow_2, over_2 = run(Demo('one', group, group), MultiThreadedExecutor(num_threads=4))
    print('one group fast', fast_2, 'slow', slow_2)
    fast_3, slow_3, over_3 = run(
        Demo('two', MutuallyExclusiveCallbackGroup(), MutuallyExclusiveCallbackGroup()), MultiThreadedExecutor(4))
    print('two groups fast', fast_3, 'slow', slow_3)
    print('overlaps', over_1, over_2, over_3)
    _, _, over_4 = run(
        Demo('reentrant', slow_group=ReentrantCallbackGroup(), slow_period=0.2), MultiThreadedExecutor(4))
    print('reentrant overlaps:', over_4 > 0)

    node = rclpy.create_node('waiting')
    future = Future()
    node.create_timer(1.0, lambda: future.done() or future.set_result(42))
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    executor.spin_until_future_complete(future, timeout_sec=0.5)
    early = future.done()
    executor.spin_until_future_complete(future)
    print(f'timed out: {early}, later: {future.done()} {future.result()}')
    executor.shutdown()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
