"""How to test a node without launch_testing: unittest, one context per test."""
import unittest

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from std_msgs.msg import Int32


class Doubler(Node):
    def __init__(self, **kwargs):
        super().__init__('doubler', **kwargs)
        self.pub = self.create_publisher(Int32, 'doubled', 10)
        self.create_subscription(Int32, 'number', lambda m: self.pub.publish(Int32(data=2 * m.data)), 10)
        self.create_service(AddTwoInts, 'add', self.add)

    def add(self, request, response):
        response.sum = request.a + request.b
        return response


class TestDoubler(unittest.TestCase):
    def setUp(self):
        self.context = Context()
        rclpy.init(context=self.context)
        self.node = Doubler(context=self.context)
        self.tester = rclpy.create_node('tester', context=self.context)
        self.executor = SingleThreadedExecutor(context=self.context)
        self.executor.add_node(self.node)
        self.executor.add_node(self.tester)

    def tearDown(self):
        self.executor.shutdown()
        self.node.destroy_node()
        self.tester.destroy_node()
        rclpy.shutdown(context=self.context)

    def spin_until(self, condition, seconds=5.0):
        end = self.tester.get_clock().now() + rclpy.duration.Duration(seconds=seconds)
        while not condition() and self.tester.get_clock().now() < end:
            self.executor.spin_once(timeout_sec=0.1)
        return condition()

    def test_doubles(self):
        got = []
        self.tester.create_subscription(Int32, 'doubled', lambda m: got.append(m.data), 10)
        pub = self.tester.create_publisher(Int32, 'number', 10)
        self.assertTrue(self.spin_until(lambda: pub.get_subscription_count() == 1))
        for number in (1, -4, 21):
            pub.publish(Int32(data=number))
        self.assertTrue(self.spin_until(lambda: len(got) == 3))
        self.assertEqual(got, [2, -8, 42])

    def test_adds(self):
        client = self.tester.create_client(AddTwoInts, 'add')
        self.assertTrue(client.wait_for_service(timeout_sec=5.0))
        future = client.call_async(AddTwoInts.Request(a=40, b=2))
        self.executor.spin_until_future_complete(future, timeout_sec=5.0)
        self.assertEqual(future.result().sum, 42)

    def test_silence(self):
        got = []
        self.tester.create_subscription(Int32, 'doubled', lambda m: got.append(m.data), 10)
        self.assertFalse(self.spin_until(lambda: got, seconds=1.0))

    def test_wrong_type(self):
        with self.assertRaises(AssertionError):
            Int32(data='three')

    def test_shut_down(self):
        self.assertTrue(self.context.ok())
        self.assertFalse(rclpy.ok())


if __name__ == '__main__':
    unittest.main(verbosity=2)
