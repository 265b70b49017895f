"""launch.events.matchers of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.entity import Action as Action
    from kit.ros.launch.events import matches_action as matches_action
else:
    _LATE_NAMES = {
        "Action": "kit.ros.launch.entity:Action",
        "matches_action": "kit.ros.launch.events:matches_action",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
