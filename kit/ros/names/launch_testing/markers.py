"""launch_testing.markers of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.testing.marks import keep_alive as keep_alive
    retry_on_failure: Any
else:
    _LATE_NAMES = {
        "keep_alive": "kit.ros.launch.testing.marks:keep_alive",
        "retry_on_failure": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
