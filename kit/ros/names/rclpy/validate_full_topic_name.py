"""rclpy.validate_full_topic_name of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.graph.naming import validate_full_topic_name

__all__ = ["validate_full_topic_name"]
