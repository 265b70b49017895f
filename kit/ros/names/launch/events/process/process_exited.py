"""launch.events.process.process_exited of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.events import ProcessExited as ProcessExited, RunningProcessEvent as RunningProcessEvent
else:
    _LATE_NAMES = {
        "ProcessExited": "kit.ros.launch.events:ProcessExited",
        "RunningProcessEvent": "kit.ros.launch.events:RunningProcessEvent",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
