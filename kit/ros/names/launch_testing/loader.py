"""launch_testing.loader of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.testing import ReadyToTest as ReadyToTest
    LoadTestsFromPythonModule: Any
    PostShutdownTestLoader: Any
    PreShutdownTestLoader: Any
    TestRun: Any
    slim_formatwarning: Any
else:
    _LATE_NAMES = {
        "LoadTestsFromPythonModule": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "PostShutdownTestLoader": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "PreShutdownTestLoader": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "ReadyToTest": "kit.ros.launch.testing:ReadyToTest",
        "TestRun": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "slim_formatwarning": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
