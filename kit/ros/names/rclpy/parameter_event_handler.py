"""rclpy.parameter_event_handler of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.parameters.parameter_client import (
    ParameterCallbackHandle,
    ParameterEventCallbackHandle,
    ParameterEventHandler,
)

__all__ = ["ParameterCallbackHandle", "ParameterEventCallbackHandle", "ParameterEventHandler"]
