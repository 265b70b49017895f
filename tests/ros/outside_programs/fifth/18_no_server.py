#!/usr/bin/env python3
"""What to do when nobody answers: time limits on services, actions, futures, transforms and messages."""
import rclpy
from example_interfaces.action import Fibonacci
from example_interfaces.srv import AddTwoInts
from rclpy.action import ActionClient
from rclpy.duration import Duration
from rclpy.executors import TimeoutException
from rclpy.node import Node
from rclpy.task import Future
from rclpy.wait_for_message import wait_for_message
from std_msgs.msg import Empty
from tf2_ros import Buffer, TransformListener, TransformException


def main():
    rclpy.init()
    node = Node('patient')
    now = lambda: node.get_clock().now().nanoseconds / 1e9
    begin = now()
    print('service', node.create_client(AddTwoInts, 'nobody').wait_for_service(timeout_sec=1.0), round(now() - begin, 1))
    begin = now()
    print('action', ActionClient(node, Fibonacci, 'nobody').wait_for_server(timeout_sec=1.0), round(now() - begin, 1))
    begin = now()
    future = Future()
    rclpy.spin_until_future_complete(node, future, timeout_sec=2.0)
    print('future', future.done(), round(now() - begin, 1))
    begin = now()
    client = node.create_client(AddTwoInts, 'nobody')
    lost = client.call_async(AddTwoInts.Request())
    rclpy.spin_until_future_complete(node, lost, timeout_sec=1.0)
    print('call', lost.done(), client.remove_pending_request(lost), lost.cancel(), lost.cancelled())
    begin = now()
    found, message = wait_for_message(Empty, node, 'silence', time_to_wait=1.5)
    print('message', found, message, round(now() - begin, 1))
    begin = now()
    rclpy.spin_once(node, timeout_sec=0.5)
    print('spin', round(now() - begin, 1))
    buffer = Buffer()
    TransformListener(buffer, node, spin_thread=True)
    begin = now()
    try:
        buffer.lookup_transform('a', 'b', rclpy.time.Time(), timeout=Duration(seconds=1))
    except TransformException as error:
        print('transform', type(error).__name__, now() - begin >= 0.9)
    executor = rclpy.executors.SingleThreadedExecutor()
    try:
        executor.wait_for_ready_callbacks
        print('executor', TimeoutException.__mro__[1].__name__ == 'Exception')
    finally:
        executor.shutdown(timeout_sec=0.1)
    print('node names', sorted(node.get_node_names())[:1], flush=True)
    rclpy.shutdown()


main()
