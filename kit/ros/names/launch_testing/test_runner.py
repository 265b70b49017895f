"""launch_testing.test_runner of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.actions import RegisterEventHandler as RegisterEventHandler
    from kit.ros.launch.entity import LaunchDescription as LaunchDescription
    from kit.ros.launch.event_handlers import (
        OnProcessExit as OnProcessExit,
        OnProcessIO as OnProcessIO,
        OnProcessStart as OnProcessStart,
    )
    from unittest import TestResult as TestResult
    ActiveIoHandler: Any
    ActiveProcInfoHandler: Any
    FailResult: Any
    LaunchService: Any
    LaunchTestRunner: Any
    SkipResult: Any
    parse_launch_arguments: Any
else:
    _LATE_NAMES = {
        "ActiveIoHandler": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "ActiveProcInfoHandler": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "FailResult": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "LaunchDescription": "kit.ros.launch.entity:LaunchDescription",
        "LaunchService": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "LaunchTestRunner": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "OnProcessExit": "kit.ros.launch.event_handlers:OnProcessExit",
        "OnProcessIO": "kit.ros.launch.event_handlers:OnProcessIO",
        "OnProcessStart": "kit.ros.launch.event_handlers:OnProcessStart",
        "RegisterEventHandler": "kit.ros.launch.actions:RegisterEventHandler",
        "SkipResult": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "TestResult": "unittest:TestResult",
        "parse_launch_arguments": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
