"""rclpy.waitable of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.node.waitable import NumberOfEntities, Waitable

__all__ = ["NumberOfEntities", "Waitable"]
