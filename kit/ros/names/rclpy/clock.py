"""rclpy.clock of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name
from kit.ros.node.clock import Clock, ClockChange, JumpHandle, JumpThreshold, ROSClock, TimeJump
from kit.ros.node.time import ClockType

__all__ = ["Clock", "ClockChange", "ClockType", "JumpHandle", "JumpThreshold", "ROSClock", "TimeJump"]

if TYPE_CHECKING:
    from enum import IntEnum as IntEnum
    from kit.ros.exceptions import NotInitializedException as NotInitializedException
    from kit.ros.execution.context import Context as Context, get_default_context as get_default_context
    from kit.ros.node.time import Duration as Duration, Time as Time
    ClockHandle: Any
    DestroyableType: Any
    JumpHandlePreCallbackType: Any
    TimeHandle: Any
    TimeJumpDictionary: Any
else:
    _LATE_NAMES = {
        "ClockHandle": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "Context": "kit.ros.execution.context:Context",
        "DestroyableType": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "Duration": "kit.ros.node.time:Duration",
        "IntEnum": "enum:IntEnum",
        "JumpHandlePreCallbackType": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "NotInitializedException": "kit.ros.exceptions:NotInitializedException",
        "Time": "kit.ros.node.time:Time",
        "TimeHandle": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "TimeJumpDictionary": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "get_default_context": "kit.ros.execution.context:get_default_context",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
