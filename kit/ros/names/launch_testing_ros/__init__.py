"""launch_testing_ros of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.testing.topics import WaitForTopics as WaitForTopics
else:
    _LATE_NAMES = {
        "WaitForTopics": "kit.ros.launch.testing.topics:WaitForTopics",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
