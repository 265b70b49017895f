"""launch_testing.io_handler of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.testing.asserts import assert_in_stream as _assertInStream
    from kit.ros.launch.testing.lookup import (
        NoMatchingProcessException as NoMatchingProcessException,
        resolve_processes as _resolveProcesses,
    )
    from kit.ros.launch.testing.records import ActiveIoHandler as ActiveIoHandler, IoHandler as IoHandler

    assertInStream = _assertInStream
    resolveProcesses = _resolveProcesses
else:
    _LATE_NAMES = {
        "ActiveIoHandler": "kit.ros.launch.testing.records:ActiveIoHandler",
        "IoHandler": "kit.ros.launch.testing.records:IoHandler",
        "NoMatchingProcessException": "kit.ros.launch.testing.lookup:NoMatchingProcessException",
        "assertInStream": "kit.ros.launch.testing.asserts:assert_in_stream",
        "resolveProcesses": "kit.ros.launch.testing.lookup:resolve_processes",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
