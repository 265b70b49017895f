"""rclpy.parameter_client of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.parameters.parameter_client import AsyncParameterClient

__all__ = ["AsyncParameterClient"]
