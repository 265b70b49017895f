"""rclpy.clock of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.node.clock import Clock, ClockChange, JumpHandle, JumpThreshold, ROSClock, TimeJump
from kit.ros.node.time import ClockType

__all__ = ["Clock", "ClockChange", "ClockType", "JumpHandle", "JumpThreshold", "ROSClock", "TimeJump"]
