"""launch.condition of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name
from kit.ros.launch.entity import Condition

__all__ = ["Condition"]

if TYPE_CHECKING:
    from kit.ros.launch.context import LaunchContext as LaunchContext
else:
    _LATE_NAMES = {
        "LaunchContext": "kit.ros.launch.context:LaunchContext",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
