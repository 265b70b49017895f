"""launch_testing.util of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.testing.lookup import (
        NO_CMD_ARGS as NO_CMD_ARGS,
        NoMatchingProcessException as NoMatchingProcessException,
        resolve_processes as _resolveProcesses,
    )
    from kit.ros.launch.testing.marks import KeepAliveProc as KeepAliveProc

    resolveProcesses = _resolveProcesses
else:
    _LATE_NAMES = {
        "KeepAliveProc": "kit.ros.launch.testing.marks:KeepAliveProc",
        "NO_CMD_ARGS": "kit.ros.launch.testing.lookup:NO_CMD_ARGS",
        "NoMatchingProcessException": "kit.ros.launch.testing.lookup:NoMatchingProcessException",
        "resolveProcesses": "kit.ros.launch.testing.lookup:resolve_processes",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
