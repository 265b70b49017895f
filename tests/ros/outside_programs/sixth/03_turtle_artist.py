"""Turtlesim: set the pen, teleport to the corners of a triangle with the pen down, clear, change the background."""
import rclpy
from rclpy.parameter import Parameter
from rclpy.parameter_client import AsyncParameterClient
from std_srvs.srv import Empty
from turtlesim.srv import SetPen, TeleportAbsolute, TeleportRelative
from turtlesim.msg import Color, Pose


def call(node, kind, name, **fields):
    client = node.create_client(kind, name)
    if not client.wait_for_service(timeout_sec=5.0):
        raise RuntimeError(f"{name} is not there")
    future = client.call_async(kind.Request(**fields))
    rclpy.spin_until_future_complete(node, future)
    return future.result()


def main():
    rclpy.init()
    node = rclpy.create_node("artist")
    pose = []
    color = []
    node.create_subscription(Pose, "/turtle1/pose", lambda m: (pose.clear(), pose.append(m)), 10)
    node.create_subscription(Color, "/turtle1/color_sensor", lambda m: (color.clear(), color.append(m)), 10)
    call(node, SetPen, "/turtle1/set_pen", r=255, g=0, b=0, width=4, off=0)
    for x, y in [(3.0, 3.0), (8.0, 3.0), (5.5, 8.0), (3.0, 3.0)]:
        call(node, TeleportAbsolute, "/turtle1/teleport_absolute", x=x, y=y, theta=0.0)
    call(node, TeleportRelative, "/turtle1/teleport_relative", linear=1.0, angular=1.5707963)
    end = node.get_clock().now().nanoseconds + int(0.2e9)
    while node.get_clock().now().nanoseconds < end:
        rclpy.spin_once(node, timeout_sec=0.05)
    node.get_logger().info(f"at {pose[0].x:.2f} {pose[0].y:.2f} {pose[0].theta:.2f}")
    params = AsyncParameterClient(node, "turtlesim")
    params.wait_for_services(5.0)
    future = params.set_parameters([Parameter("background_r", value=10), Parameter("background_g", value=20)])
    rclpy.spin_until_future_complete(node, future)
    node.get_logger().info(f"set: {[r.successful for r in future.result().results]}")
    call(node, Empty, "/clear")
    end = node.get_clock().now().nanoseconds + int(0.2e9)
    while node.get_clock().now().nanoseconds < end:
        rclpy.spin_once(node, timeout_sec=0.05)
    node.get_logger().info(f"background {color[0].r} {color[0].g} {color[0].b}")
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
