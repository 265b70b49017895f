"""rosidl_runtime_py.set_message of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.interface_functions import set_message_fields

__all__ = ["set_message_fields"]
