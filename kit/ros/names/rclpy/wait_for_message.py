"""rclpy.wait_for_message of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.execution.client_library import wait_for_message

__all__ = ["wait_for_message"]
