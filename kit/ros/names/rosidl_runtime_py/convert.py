"""rosidl_runtime_py.convert of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.interface_functions import message_to_csv, message_to_ordereddict, message_to_yaml

__all__ = ["message_to_csv", "message_to_ordereddict", "message_to_yaml"]
