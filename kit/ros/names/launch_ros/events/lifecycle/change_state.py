"""launch_ros.events.lifecycle.change_state of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.events import ChangeState as ChangeState, Event as Event
    from kit.ros.launch.processes import LifecycleNode as LifecycleNode
else:
    _LATE_NAMES = {
        "ChangeState": "kit.ros.launch.events:ChangeState",
        "Event": "kit.ros.launch.events:Event",
        "LifecycleNode": "kit.ros.launch.processes:LifecycleNode",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
