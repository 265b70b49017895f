"""rclpy.task of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.execution.task import Future, Task
from kit.ros.late_names import import_late_name

__all__ = ["Future", "Task"]

if TYPE_CHECKING:
    from kit.ros.execution.executors import Executor as Executor
    from kit.ros.type_support import T as T
else:
    _LATE_NAMES = {
        "Executor": "kit.ros.execution.executors:Executor",
        "T": "kit.ros.type_support:T",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
