"""rclpy.validate_topic_name of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.graph.naming import TOPIC_SEPARATOR_STRING, validate_topic_name

__all__ = ["TOPIC_SEPARATOR_STRING", "validate_topic_name"]
