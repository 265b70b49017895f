"""launch_ros.events.lifecycle of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.launch.events import ChangeState, StateTransition, matches_node_name

__all__ = ["ChangeState", "StateTransition", "matches_node_name"]
