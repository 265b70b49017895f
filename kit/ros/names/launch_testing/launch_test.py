"""launch_testing.launch_test of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from launch_testing import parse_arguments as parse_arguments
    LaunchTestRunner: Any
    LoadTestsFromPythonModule: Any
    add_arguments: Any
    main: Any
    print_arguments_of_launch_description: Any
    run: Any
    unittestResultsToXml: Any
else:
    _LATE_NAMES = {
        "LaunchTestRunner": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "LoadTestsFromPythonModule": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "add_arguments": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "main": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "parse_arguments": "launch_testing.parse_arguments",
        "print_arguments_of_launch_description": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "run": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "unittestResultsToXml": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
