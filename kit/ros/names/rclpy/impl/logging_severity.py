"""rclpy.impl.logging_severity of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.log import LoggingSeverity

__all__ = ["LoggingSeverity"]
