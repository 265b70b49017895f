"""rclpy.lifecycle.node of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.lifecycle import LifecycleNode, LifecycleNodeMixin, LifecycleState, TransitionCallbackReturn

__all__ = ["LifecycleNode", "LifecycleNodeMixin", "LifecycleState", "TransitionCallbackReturn"]
