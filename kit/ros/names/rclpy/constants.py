"""rclpy.constants of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.node.time import S_TO_NS

__all__ = ["S_TO_NS"]
