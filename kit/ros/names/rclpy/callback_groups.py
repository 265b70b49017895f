"""rclpy.callback_groups of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.execution.callback_groups import (
    CallbackGroup,
    MutuallyExclusiveCallbackGroup,
    ReentrantCallbackGroup,
)

__all__ = ["CallbackGroup", "MutuallyExclusiveCallbackGroup", "ReentrantCallbackGroup"]
