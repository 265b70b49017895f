"""launch.events.timer_event of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.actions import TimerAction as TimerAction
    from kit.ros.launch.events import Event as Event
    TimerEvent: Any
else:
    _LATE_NAMES = {
        "Event": "kit.ros.launch.events:Event",
        "TimerAction": "kit.ros.launch.actions:TimerAction",
        "TimerEvent": "!launch's own process, in whose place `kit launch FILE` runs launch files",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
