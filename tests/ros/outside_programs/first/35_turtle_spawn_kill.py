#!/usr/bin/env python3
import rclpy
from rclpy.node import Node
from turtlesim.srv import Spawn, Kill


class TurtleManager(Node):
    def __init__(self):
        super().__init__("turtle_manager")
        self.spawn_client_ = self.create_client(Spawn, "/spawn")
        self.kill_client_ = self.create_client(Kill, "/kill")
        while not self.spawn_client_.wait_for_service(1.0):
            self.get_logger().warn("Waiting for Server Spawn...")
        self.kill_client_.wait_for_service()

    def spawn(self, x, y, theta, name=""):
        request = Spawn.Request()
        request.x, request.y, request.theta, request.name = x, y, theta, name
        future = self.spawn_client_.call_async(request)
        rclpy.spin_until_future_complete(self, future)
        return future.result().name

    def kill(self, name):
        future = self.kill_client_.call_async(Kill.Request(name=name))
        rclpy.spin_until_future_complete(self, future)


def main(args=None):
    rclpy.init(args=args)
    node = TurtleManager()
    for i in range(3):
        name = node.spawn(2.0 + 3 * i, 8.0, 0.0)
        node.get_logger().info(f"spawned {name}")
    node.spawn(5.0, 2.0, 1.57, "leonardo")
    node.kill("turtle3")
    node.get_logger().info("turtle3 is gone")
    duplicate = node.spawn(1.0, 1.0, 0.0, "leonardo")
    node.get_logger().info(f"duplicate gave '{duplicate}'")
    rclpy.shutdown()


if __name__ == "__main__":
    main()
