"""rclpy.utilities of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.execution.client_library import (
    get_available_rmw_implementations,
    get_rmw_implementation_identifier,
    ok,
    remove_ros_args,
    shutdown,
    timeout_sec_to_nsec,
    try_shutdown,
)
from kit.ros.execution.context import get_default_context

__all__ = [
    "get_available_rmw_implementations",
    "get_default_context",
    "get_rmw_implementation_identifier",
    "ok",
    "remove_ros_args",
    "shutdown",
    "timeout_sec_to_nsec",
    "try_shutdown",
]
