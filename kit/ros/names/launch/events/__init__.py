"""launch.events of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.launch.events import ExecutionComplete, IncludeLaunchDescription, Shutdown, matches_action

__all__ = ["ExecutionComplete", "IncludeLaunchDescription", "Shutdown", "matches_action"]
