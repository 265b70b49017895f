"""rclpy.subscription of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.node.subscription import MessageInfo, Subscription

__all__ = ["MessageInfo", "Subscription"]
