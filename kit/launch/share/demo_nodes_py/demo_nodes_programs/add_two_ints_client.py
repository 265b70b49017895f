"""Asks ``add_two_ints`` for 2 + 3."""

import rclpy
from example_interfaces.srv import AddTwoInts


def main() -> None:
    rclpy.init()
    node = rclpy.create_node("add_two_ints_client")
    client = node.create_client(AddTwoInts, "add_two_ints")
    while not client.wait_for_service(timeout_sec=1.0):
        node.get_logger().info("service not available, waiting again...")
    future = client.call_async(AddTwoInts.Request(a=2, b=3))
    rclpy.spin_until_future_complete(node, future)
    response = future.result()
    assert response is not None  # it has been waited for
    node.get_logger().info(f"Result of add_two_ints: {response.sum}")
    rclpy.shutdown()
