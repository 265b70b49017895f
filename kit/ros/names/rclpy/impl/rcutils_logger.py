"""rclpy.impl.rcutils_logger of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.log import RcutilsLogger

__all__ = ["RcutilsLogger"]
