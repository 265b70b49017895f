"""launch_testing.markers of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.testing import keep_alive as keep_alive
    retry_on_failure: Any
else:
    _LATE_NAMES = {
        "keep_alive": "kit.ros.launch.testing:keep_alive",
        "retry_on_failure": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
