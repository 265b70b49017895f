"""rclpy.timer of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.node.timer import Rate, Timer, TimerInfo

__all__ = ["Rate", "Timer", "TimerInfo"]
