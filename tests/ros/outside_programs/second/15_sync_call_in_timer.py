#!/usr/bin/env python3
# client.call() (the blocking one) inside a timer, which works because the groups differ
import rclpy
from rclpy.node import Node, MutuallyExclusiveCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from std_msgs.msg import Empty as EmptyMsg
from example_interfaces.srv import AddTwoInts


class CallingNode(Node):
    def __init__(self):
        super().__init__('calling_node')
        client_cb_group = MutuallyExclusiveCallbackGroup()
        timer_cb_group = MutuallyExclusiveCallbackGroup()
        self.client = self.create_client(AddTwoInts, '/slow_add', callback_group=client_cb_group)
        self.call_timer = self.create_timer(1, self._timer_cb, callback_group=timer_cb_group)
        self.alive_timer = self.create_timer(0.1, self._alive)      # default group
        self.alive = 0
        self.n = 0

    def _alive(self):
        self.alive += 1

    def _timer_cb(self):
        self.client.wait_for_service()
        self.n += 1
        before = self.alive
        self.get_logger().info(f'Sending request {self.n}')
        res = self.client.call(AddTwoInts.Request(a=self.n, b=100))
        busy = 'alive meanwhile' if self.alive > before else 'frozen meanwhile'
        self.get_logger().info(f'Received {res.sum}, {busy}')


def main():
    rclpy.init()
    node = CallingNode()
    executor = MultiThreadedExecutor(num_threads=3)
    executor.add_node(node)
    try:
        node.get_logger().info('Beginning client, shut down with CTRL-C')
        executor.spin()
    except KeyboardInterrupt:
        node.get_logger().info('Keyboard interrupt, shutting down.\n')
    node.destroy_node()
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
