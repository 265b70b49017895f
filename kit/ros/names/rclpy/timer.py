"""rclpy.timer of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name
from kit.ros.node.timer import Rate, Timer, TimerInfo

__all__ = ["Rate", "Timer", "TimerInfo"]

if TYPE_CHECKING:
    from kit.ros.exceptions import InvalidHandle as InvalidHandle, ROSInterruptException as ROSInterruptException
    from kit.ros.execution.callback_groups import CallbackGroup as CallbackGroup
    from kit.ros.execution.context import Context as Context, get_default_context as get_default_context
    from kit.ros.node.clock import Clock as Clock
    from kit.ros.node.time import ClockType as ClockType, Time as Time
else:
    _LATE_NAMES = {
        "CallbackGroup": "kit.ros.execution.callback_groups:CallbackGroup",
        "Clock": "kit.ros.node.clock:Clock",
        "ClockType": "kit.ros.node.time:ClockType",
        "Context": "kit.ros.execution.context:Context",
        "InvalidHandle": "kit.ros.exceptions:InvalidHandle",
        "ROSInterruptException": "kit.ros.exceptions:ROSInterruptException",
        "Time": "kit.ros.node.time:Time",
        "get_default_context": "kit.ros.execution.context:get_default_context",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
