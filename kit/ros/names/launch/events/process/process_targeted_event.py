"""launch.events.process.process_targeted_event of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.events import Event as Event, ProcessMatchingEvent as _ProcessTargetedEvent
    from kit.ros.launch.processes import ExecuteLocal as ExecuteLocal, ExecuteProcess as ExecuteProcess

    ProcessTargetedEvent = _ProcessTargetedEvent
else:
    _LATE_NAMES = {
        "Event": "kit.ros.launch.events:Event",
        "ExecuteLocal": "kit.ros.launch.processes:ExecuteLocal",
        "ExecuteProcess": "kit.ros.launch.processes:ExecuteProcess",
        "ProcessTargetedEvent": "kit.ros.launch.events:ProcessMatchingEvent",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
