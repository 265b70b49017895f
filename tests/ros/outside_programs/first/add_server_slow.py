#!/usr/bin/env python3
# comes up two seconds late on purpose
import time
from example_interfaces.srv import AddTwoInts
import rclpy


def main():
    rclpy.init()
    node = rclpy.create_node("add_two_ints_server")
    time.sleep(2)

    def add(request, response):
        response.sum = request.a + request.b
        node.get_logger().info(f"Incoming request a: {request.a} b: {request.b}")
        return response

    node.create_service(AddTwoInts, "add_two_ints", add)
    rclpy.spin(node)


if __name__ == "__main__":
    main()
