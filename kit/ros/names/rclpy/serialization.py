"""rclpy.serialization of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.serialization import deserialize_message, serialize_message

__all__ = ["deserialize_message", "serialize_message"]
