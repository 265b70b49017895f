"""launch.events.shutdown of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.events import Event as Event, Shutdown as Shutdown
else:
    _LATE_NAMES = {
        "Event": "kit.ros.launch.events:Event",
        "Shutdown": "kit.ros.launch.events:Shutdown",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
