"""launch_testing.decorator of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.testing.marks import post_shutdown_test as post_shutdown_test
else:
    _LATE_NAMES = {
        "post_shutdown_test": "kit.ros.launch.testing.marks:post_shutdown_test",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
