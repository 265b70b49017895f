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
        "LaunchTestRunner": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
        "LoadTestsFromPythonModule": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
        "add_arguments": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
        "main": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
        "parse_arguments": "launch_testing.parse_arguments",
        "print_arguments_of_launch_description": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
        "run": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
        "unittestResultsToXml": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
