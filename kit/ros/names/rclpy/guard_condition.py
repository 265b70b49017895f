"""rclpy.guard_condition of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name
from kit.ros.node.waitable import WaitableGuardCondition as GuardCondition

__all__ = ["GuardCondition"]

if TYPE_CHECKING:
    from kit.ros.execution.callback_groups import CallbackGroup as CallbackGroup
    from kit.ros.execution.context import Context as Context, get_default_context as get_default_context
else:
    _LATE_NAMES = {
        "CallbackGroup": "kit.ros.execution.callback_groups:CallbackGroup",
        "Context": "kit.ros.execution.context:Context",
        "get_default_context": "kit.ros.execution.context:get_default_context",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
