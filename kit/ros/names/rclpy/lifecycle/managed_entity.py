"""rclpy.lifecycle.managed_entity of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.lifecycle import ManagedEntity, SimpleManagedEntity

__all__ = ["ManagedEntity", "SimpleManagedEntity"]
