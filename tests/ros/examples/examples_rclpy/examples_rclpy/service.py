"""Serves a service by a function of the module."""

import rclpy
from example_interfaces.srv import AddTwoInts

g_node = None


def add_two_ints_callback(request, response):
    response.sum = request.a + request.b
    g_node.get_logger().info("Incoming request\na: %d b: %d" % (request.a, request.b))
    return response


def main(args=None):
    global g_node
    rclpy.init(args=args)
    g_node = rclpy.create_node("minimal_service")
    srv = g_node.create_service(AddTwoInts, "add_two_ints", add_two_ints_callback)
    while rclpy.ok():
        rclpy.spin_once(g_node)
    g_node.destroy_service(srv)
    rclpy.shutdown()


if __name__ == "__main__":
    main()
