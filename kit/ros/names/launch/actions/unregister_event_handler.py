"""launch.actions.unregister_event_handler of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.actions import UnregisterEventHandler as UnregisterEventHandler
    from kit.ros.launch.context import LaunchContext as LaunchContext
    from kit.ros.launch.entity import Action as Action
    from kit.ros.launch.event_handlers import EventHandler as _BaseEventHandler

    BaseEventHandler = _BaseEventHandler
else:
    _LATE_NAMES = {
        "Action": "kit.ros.launch.entity:Action",
        "BaseEventHandler": "kit.ros.launch.event_handlers:EventHandler",
        "LaunchContext": "kit.ros.launch.context:LaunchContext",
        "UnregisterEventHandler": "kit.ros.launch.actions:UnregisterEventHandler",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
