"""rclpy.task of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.execution.task import Future, Task

__all__ = ["Future", "Task"]
