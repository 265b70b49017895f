"""launch.events.execution_complete of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.entity import Action as Action
    from kit.ros.launch.events import Event as Event, ExecutionComplete as ExecutionComplete
else:
    _LATE_NAMES = {
        "Action": "kit.ros.launch.entity:Action",
        "Event": "kit.ros.launch.events:Event",
        "ExecutionComplete": "kit.ros.launch.events:ExecutionComplete",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
