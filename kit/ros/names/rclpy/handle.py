"""rclpy.handle of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.exceptions import InvalidHandle

__all__ = ["InvalidHandle"]
