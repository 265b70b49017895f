"""rclpy.type_hash of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    TypeHash: Any
    TypeHashDictionary: Any
else:
    _LATE_NAMES = {
        "TypeHash": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "TypeHashDictionary": "!rclpy's library in C, in whose place the kit has a graph of its own",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
