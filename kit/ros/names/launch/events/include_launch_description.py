"""launch.events.include_launch_description of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.entity import LaunchDescription as LaunchDescription
    from kit.ros.launch.events import Event as Event, IncludeLaunchDescription as IncludeLaunchDescription
else:
    _LATE_NAMES = {
        "Event": "kit.ros.launch.events:Event",
        "IncludeLaunchDescription": "kit.ros.launch.events:IncludeLaunchDescription",
        "LaunchDescription": "kit.ros.launch.entity:LaunchDescription",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
