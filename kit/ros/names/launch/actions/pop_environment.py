"""launch.actions.pop_environment of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.context import LaunchContext as LaunchContext
    from kit.ros.launch.entity import Action as Action
    from kit.ros.launch.settings import PopEnvironment as PopEnvironment
else:
    _LATE_NAMES = {
        "Action": "kit.ros.launch.entity:Action",
        "LaunchContext": "kit.ros.launch.context:LaunchContext",
        "PopEnvironment": "kit.ros.launch.settings:PopEnvironment",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
