"""rosidl_runtime_py.get_interfaces of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.interface_functions import (
    get_action_interfaces,
    get_interface_packages,
    get_interface_path,
    get_interfaces,
    get_message_interfaces,
    get_service_interfaces,
)

__all__ = [
    "get_action_interfaces",
    "get_interface_packages",
    "get_interface_path",
    "get_interfaces",
    "get_message_interfaces",
    "get_service_interfaces",
]
