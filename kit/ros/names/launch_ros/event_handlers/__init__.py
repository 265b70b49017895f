"""launch_ros.event_handlers of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.launch.event_handlers import OnStateTransition

__all__ = ["OnStateTransition"]
