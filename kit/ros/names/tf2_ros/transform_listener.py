"""tf2_ros.transform_listener of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.tf import TransformListener

__all__ = ["TransformListener"]
