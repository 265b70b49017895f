"""launch.event_handlers.on_include_launch_description of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.event_handlers import EventHandler as EventHandler
    from kit.ros.launch.events import IncludeLaunchDescription as IncludeLaunchDescription
    from kit.ros.launch.normalization import is_a_subclass as is_a_subclass
    OnIncludeLaunchDescription: Any
else:
    _LATE_NAMES = {
        "EventHandler": "kit.ros.launch.event_handlers:EventHandler",
        "IncludeLaunchDescription": "kit.ros.launch.events:IncludeLaunchDescription",
        "OnIncludeLaunchDescription": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "is_a_subclass": "kit.ros.launch.normalization:is_a_subclass",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
