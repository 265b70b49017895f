"""rclpy.context of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.execution.context import Context

__all__ = ["Context"]
