"""launch.descriptions of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.launch.processes import Executable

__all__ = ["Executable"]
