"""rclpy.time of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.node.time import Time

__all__ = ["Time"]
