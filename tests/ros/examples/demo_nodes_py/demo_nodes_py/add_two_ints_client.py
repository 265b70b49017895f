"""Has two numbers added."""

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.executors import ExternalShutdownException


def main(args=None):
    try:
        with rclpy.init(args=args):
            node = rclpy.create_node("add_two_ints_client")
            cli = node.create_client(AddTwoInts, "add_two_ints")
            while not cli.wait_for_service(timeout_sec=1.0):
                print("service not available, waiting again...")
            req = AddTwoInts.Request()
            req.a = 2
            req.b = 3
            future = cli.call_async(req)
            rclpy.spin_until_future_complete(node, future)
            if future.result() is not None:
                node.get_logger().info("Result of add_two_ints: %d" % future.result().sum)
            else:
                node.get_logger().error("Exception while calling service: %r" % future.exception())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == "__main__":
    main()
