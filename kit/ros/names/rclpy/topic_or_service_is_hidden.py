"""rclpy.topic_or_service_is_hidden of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.graph.naming import topic_or_service_is_hidden

__all__ = ["topic_or_service_is_hidden"]
