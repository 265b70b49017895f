"""rclpy.lifecycle.publisher of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.lifecycle import LifecyclePublisher

__all__ = ["LifecyclePublisher"]
