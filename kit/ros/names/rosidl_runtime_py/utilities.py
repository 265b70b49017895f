"""rosidl_runtime_py.utilities of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.interface_functions import (
    get_action,
    get_interface,
    get_message,
    get_service,
    is_action,
    is_message,
    is_service,
)

__all__ = [
    "get_action",
    "get_interface",
    "get_message",
    "get_service",
    "is_action",
    "is_message",
    "is_service",
]
