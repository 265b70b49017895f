"""Calls a service within a callback of a timer, and awaits the answer there."""

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import ReentrantCallbackGroup


def main(args=None):
    rclpy.init(args=args)
    node = rclpy.create_node("minimal_client")
    # Timer and client in a group that lets their callbacks overlap, so that the answer is handled while one awaits.
    cb_group = ReentrantCallbackGroup()
    cli = node.create_client(AddTwoInts, "add_two_ints", callback_group=cb_group)
    did_run = False
    did_get_result = False

    async def call_service():
        nonlocal did_run, did_get_result
        did_run = True
        try:
            req = AddTwoInts.Request()
            req.a = 41
            req.b = 1
            future = cli.call_async(req)
            result = await future
            node.get_logger().info("Result of add_two_ints: for %d + %d = %d" % (req.a, req.b, result.sum))
        finally:
            did_get_result = True

    while not cli.wait_for_service(timeout_sec=1.0):
        node.get_logger().info("service not available, waiting again...")
    timer = node.create_timer(0.5, call_service, callback_group=cb_group)
    while rclpy.ok() and not did_run:
        rclpy.spin_once(node)
    if did_run:
        timer.cancel()
    while rclpy.ok() and not did_get_result:
        rclpy.spin_once(node)
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
