"""launch_testing.tools of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    ProcessProxy: Any
    basic_output_filter: Any
    expect_output: Any
    expected_output_from_file: Any
    launch_process: Any
else:
    _LATE_NAMES = {
        "ProcessProxy": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
        "basic_output_filter": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
        "expect_output": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
        "expected_output_from_file": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
        "launch_process": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
