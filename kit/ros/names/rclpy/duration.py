"""rclpy.duration of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name
from kit.ros.node.time import Duration, Infinite

__all__ = ["Duration", "Infinite"]

if TYPE_CHECKING:
    from kit.ros.node.time import S_TO_NS as S_TO_NS
    DurationType: Any
else:
    _LATE_NAMES = {
        "DurationType": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "S_TO_NS": "kit.ros.node.time:S_TO_NS",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
