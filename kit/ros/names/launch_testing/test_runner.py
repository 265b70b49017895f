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
    from kit.ros.launch.testing.records import (
        ActiveIoHandler as ActiveIoHandler,
        ActiveProcInfoHandler as ActiveProcInfoHandler,
    )
    from unittest import TestResult as TestResult
    FailResult: Any
    LaunchService: Any
    LaunchTestRunner: Any
    SkipResult: Any
    parse_launch_arguments: Any
else:
    _LATE_NAMES = {
        "ActiveIoHandler": "kit.ros.launch.testing.records:ActiveIoHandler",
        "ActiveProcInfoHandler": "kit.ros.launch.testing.records:ActiveProcInfoHandler",
        "FailResult": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
        "LaunchDescription": "kit.ros.launch.entity:LaunchDescription",
        "LaunchService": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
        "LaunchTestRunner": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
        "OnProcessExit": "kit.ros.launch.event_handlers:OnProcessExit",
        "OnProcessIO": "kit.ros.launch.event_handlers:OnProcessIO",
        "OnProcessStart": "kit.ros.launch.event_handlers:OnProcessStart",
        "RegisterEventHandler": "kit.ros.launch.actions:RegisterEventHandler",
        "SkipResult": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
        "TestResult": "unittest:TestResult",
        "parse_launch_arguments": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
