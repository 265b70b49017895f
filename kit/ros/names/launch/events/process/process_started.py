"""launch.events.process.process_started of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.events import (
        ProcessStarted as ProcessStarted,
        RunningProcessEvent as RunningProcessEvent,
    )
else:
    _LATE_NAMES = {
        "ProcessStarted": "kit.ros.launch.events:ProcessStarted",
        "RunningProcessEvent": "kit.ros.launch.events:RunningProcessEvent",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
