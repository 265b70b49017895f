"""launch_ros.events.matchers of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from launch_ros.events.matchers.matches_node_name import matches_node_name

__all__ = ["matches_node_name"]
