"""tf2_ros.buffer of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.tf import Buffer

__all__ = ["Buffer"]
