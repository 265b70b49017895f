"""launch.event_handler of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.launch.event_handlers import EventHandler

__all__ = ["EventHandler"]
