"""One node changes what another one logs."""

import threading
import time

import rclpy
from example_interfaces.msg import String
from rcl_interfaces.msg import LoggerLevel
from rcl_interfaces.srv import GetLoggerLevels, SetLoggerLevels
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.impl.logging_severity import LoggingSeverity
from rclpy.node import Node


class LoggerServiceNode(Node):
    def __init__(self):
        super().__init__("LoggerServiceNode", enable_logger_service=True)
        self.sub = self.create_subscription(String, "output", self.callback, 10)

    def callback(self, msg):
        self.get_logger().debug(msg.data + " with DEBUG logger level.")
        self.get_logger().info(msg.data + " with INFO logger level.")
        self.get_logger().warning(msg.data + " with WARN logger level.")
        self.get_logger().error(msg.data + " with ERROR logger level.")


class TestNode(Node):
    def __init__(self, remote_node_name):
        super().__init__("TestNode")
        self.pub = self.create_publisher(String, "output", 10)
        self._get_client = self.create_client(GetLoggerLevels, remote_node_name + "/get_logger_levels")
        self._set_client = self.create_client(SetLoggerLevels, remote_node_name + "/set_logger_levels")
        self._remote_node_name = remote_node_name

    def set_logger_level(self, level):
        request = SetLoggerLevels.Request()
        request.levels = [LoggerLevel(name=self._remote_node_name, level=level)]
        future = self._set_client.call_async(request)
        rclpy.spin_until_future_complete(self, future)
        return future.result().results[0].successful

    def get_logger_level(self):
        future = self._get_client.call_async(GetLoggerLevels.Request(names=[self._remote_node_name]))
        rclpy.spin_until_future_complete(self, future)
        return future.result().levels[0].level


def main(args=None):
    try:
        with rclpy.init(args=args):
            logger_service_node = LoggerServiceNode()
            test_node = TestNode("LoggerServiceNode")
            executor = SingleThreadedExecutor()
            executor.add_node(logger_service_node)
            thread = threading.Thread(target=executor.spin)
            thread.start()
            for level in (None, LoggingSeverity.DEBUG, LoggingSeverity.WARN, LoggingSeverity.ERROR):
                if level is not None:
                    test_node.set_logger_level(level)
                test_node.pub.publish(String(data=f"Output {level and level.name}"))
                time.sleep(0.5)
                test_node.get_logger().info(f"Current logger level: {test_node.get_logger_level()}")
            executor.shutdown()
            if thread.is_alive():
                thread.join()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == "__main__":
    main()
