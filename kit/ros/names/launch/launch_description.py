"""launch.launch_description of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.launch.entity import LaunchDescription

__all__ = ["LaunchDescription"]
