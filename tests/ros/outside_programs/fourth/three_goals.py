import rclpy
from example_interfaces.action import Fibonacci
from rclpy.action import ActionClient


def main():
    rclpy.init()
    node = rclpy.create_node("three_goals")
    client = ActionClient(node, Fibonacci, "fibonacci")
    assert client.wait_for_server(timeout_sec=10.0)
    t0 = node.get_clock().now()
    sends = [client.send_goal_async(Fibonacci.Goal(order=n)) for n in (5, 4, 0, 3)]
    handles = []
    for send in sends:
        rclpy.spin_until_future_complete(node, send)
        handles.append(send.result())
    print([h.accepted for h in handles])
    handles[1].cancel_goal_async()
    for h in handles:
        if h.accepted:
            got = h.get_result_async()
            rclpy.spin_until_future_complete(node, got)
            took = (node.get_clock().now() - t0).nanoseconds / 1e9
            print("goal", got.result().status, list(got.result().result.sequence), f"{took:.0f} s", flush=True)
    rclpy.shutdown()


main()
