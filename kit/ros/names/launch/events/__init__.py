"""launch.events of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name
from kit.ros.launch.events import ExecutionComplete, IncludeLaunchDescription, Shutdown, matches_action

__all__ = ["ExecutionComplete", "IncludeLaunchDescription", "Shutdown", "matches_action"]

if TYPE_CHECKING:
    from launch.events import process as process
    TimerEvent: Any
else:
    _LATE_NAMES = {
        "TimerEvent": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "process": "launch.events.process",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
