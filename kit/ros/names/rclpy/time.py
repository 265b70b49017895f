"""rclpy.time of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name
from kit.ros.node.time import Time

__all__ = ["Time"]

if TYPE_CHECKING:
    from kit.ros.constants import NS_PER_S as _CONVERSION_CONSTANT
    from kit.ros.node.time import ClockType as ClockType, Duration as Duration, S_TO_NS as S_TO_NS

    CONVERSION_CONSTANT = _CONVERSION_CONSTANT
    TimeHandle: Any
else:
    _LATE_NAMES = {
        "CONVERSION_CONSTANT": "kit.ros.constants:NS_PER_S",
        "ClockType": "kit.ros.node.time:ClockType",
        "Duration": "kit.ros.node.time:Duration",
        "S_TO_NS": "kit.ros.node.time:S_TO_NS",
        "TimeHandle": "!rclpy's library in C, in whose place the kit has a graph of its own",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
