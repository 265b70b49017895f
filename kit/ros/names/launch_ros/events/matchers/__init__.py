"""launch_ros.events.matchers of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.launch.events import matches_node_name

__all__ = ["matches_node_name"]
