"""rclpy.validate_node_name of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.graph.naming import validate_node_name

__all__ = ["validate_node_name"]
