"""rclpy.waitable of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name
from kit.ros.node.waitable import NumberOfEntities, Waitable

__all__ = ["NumberOfEntities", "Waitable"]

if TYPE_CHECKING:
    from kit.ros.execution.callback_groups import CallbackGroup as CallbackGroup
    from kit.ros.execution.task import Future as Future
    from kit.ros.type_support import T as T
else:
    _LATE_NAMES = {
        "CallbackGroup": "kit.ros.execution.callback_groups:CallbackGroup",
        "Future": "kit.ros.execution.task:Future",
        "T": "kit.ros.type_support:T",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
