"""launch_testing.actions of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.testing import ReadyToTest as ReadyToTest
    GTest: Any
    PyTest: Any
else:
    _LATE_NAMES = {
        "GTest": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "PyTest": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "ReadyToTest": "kit.ros.launch.testing:ReadyToTest",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
