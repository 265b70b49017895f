"""rclpy.signals of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.execution.client_library import SignalHandlerOptions

__all__ = ["SignalHandlerOptions"]
