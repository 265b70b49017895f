"""launch_testing.ready_to_test_action_timeout of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.testing.marks import ready_to_test_action_timeout as ready_to_test_action_timeout
else:
    _LATE_NAMES = {
        "ready_to_test_action_timeout": "kit.ros.launch.testing.marks:ready_to_test_action_timeout",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
