"""rclpy.clock_type of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name
from kit.ros.node.time import ClockType

__all__ = ["ClockType"]

if TYPE_CHECKING:
    from enum import IntEnum as IntEnum
else:
    _LATE_NAMES = {
        "IntEnum": "enum:IntEnum",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
