"""rclpy.publisher of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.node.publisher import Publisher

__all__ = ["Publisher"]
