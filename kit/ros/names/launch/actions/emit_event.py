"""launch.actions.emit_event of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.actions import EmitEvent as EmitEvent
    from kit.ros.launch.context import LaunchContext as LaunchContext
    from kit.ros.launch.entity import Action as Action
    from kit.ros.launch.events import Event as Event
    from kit.ros.launch.normalization import is_a_subclass as is_a_subclass
else:
    _LATE_NAMES = {
        "Action": "kit.ros.launch.entity:Action",
        "EmitEvent": "kit.ros.launch.actions:EmitEvent",
        "Event": "kit.ros.launch.events:Event",
        "LaunchContext": "kit.ros.launch.context:LaunchContext",
        "is_a_subclass": "kit.ros.launch.normalization:is_a_subclass",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
