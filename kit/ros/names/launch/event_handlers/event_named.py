"""launch.event_handlers.event_named of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.events import Event as Event, event_named as event_named
else:
    _LATE_NAMES = {
        "Event": "kit.ros.launch.events:Event",
        "event_named": "kit.ros.launch.events:event_named",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
