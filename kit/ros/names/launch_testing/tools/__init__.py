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
        "ProcessProxy": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "basic_output_filter": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "expect_output": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "expected_output_from_file": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "launch_process": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
