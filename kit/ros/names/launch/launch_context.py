"""launch.launch_context of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.launch.context import LaunchContext

__all__ = ["LaunchContext"]
