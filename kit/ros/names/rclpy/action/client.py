"""rclpy.action.client of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.action.client import ActionClient, ClientGoalHandle

__all__ = ["ActionClient", "ClientGoalHandle"]
