"""rclpy.clock_type of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.node.time import ClockType

__all__ = ["ClockType"]
