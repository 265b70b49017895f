"""launch_testing.loader of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.testing.marks import ReadyToTest as ReadyToTest
    LoadTestsFromPythonModule: Any
    PostShutdownTestLoader: Any
    PreShutdownTestLoader: Any
    TestRun: Any
    slim_formatwarning: Any
else:
    _LATE_NAMES = {
        "LoadTestsFromPythonModule": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
        "PostShutdownTestLoader": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
        "PreShutdownTestLoader": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
        "ReadyToTest": "kit.ros.launch.testing.marks:ReadyToTest",
        "TestRun": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
        "slim_formatwarning": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
