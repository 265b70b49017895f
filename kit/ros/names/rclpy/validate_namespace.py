"""rclpy.validate_namespace of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.graph.naming import validate_namespace

__all__ = ["validate_namespace"]
