"""launch_testing.actions.ready of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.context import LaunchContext as LaunchContext
    from kit.ros.launch.entity import Action as Action, LaunchDescriptionEntity as LaunchDescriptionEntity
    from kit.ros.launch.testing.marks import ReadyToTest as ReadyToTest
else:
    _LATE_NAMES = {
        "Action": "kit.ros.launch.entity:Action",
        "LaunchContext": "kit.ros.launch.context:LaunchContext",
        "LaunchDescriptionEntity": "kit.ros.launch.entity:LaunchDescriptionEntity",
        "ReadyToTest": "kit.ros.launch.testing.marks:ReadyToTest",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
