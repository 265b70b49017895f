"""launch_testing.util of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.testing import KeepAliveProc as KeepAliveProc
    NO_CMD_ARGS: Any
    NoMatchingProcessException: Any
    resolveProcesses: Any
else:
    _LATE_NAMES = {
        "KeepAliveProc": "kit.ros.launch.testing:KeepAliveProc",
        "NO_CMD_ARGS": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "NoMatchingProcessException": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "resolveProcesses": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
