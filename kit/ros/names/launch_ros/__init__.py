"""launch_ros of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from launch_ros import (
        actions as actions,
        descriptions as descriptions,
        event_handlers as event_handlers,
        events as events,
        ros_adapters as ros_adapters,
        substitutions as substitutions,
    )
else:
    _LATE_NAMES = {
        "actions": "launch_ros.actions",
        "descriptions": "launch_ros.descriptions",
        "event_handlers": "launch_ros.event_handlers",
        "events": "launch_ros.events",
        "ros_adapters": "launch_ros.ros_adapters",
        "substitutions": "launch_ros.substitutions",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
