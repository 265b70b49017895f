"""launch.events.process.running_process_event of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.events import Event as Event, RunningProcessEvent as RunningProcessEvent
    from kit.ros.launch.processes import ExecuteProcess as ExecuteProcess
else:
    _LATE_NAMES = {
        "Event": "kit.ros.launch.events:Event",
        "ExecuteProcess": "kit.ros.launch.processes:ExecuteProcess",
        "RunningProcessEvent": "kit.ros.launch.events:RunningProcessEvent",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
