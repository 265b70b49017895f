"""launch_testing.util.proc_lookup of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.testing.lookup import (
        NO_CMD_ARGS as NO_CMD_ARGS,
        NoMatchingProcessException as NoMatchingProcessException,
        resolve_processes as _resolveProcesses,
    )

    resolveProcesses = _resolveProcesses
else:
    _LATE_NAMES = {
        "NO_CMD_ARGS": "kit.ros.launch.testing.lookup:NO_CMD_ARGS",
        "NoMatchingProcessException": "kit.ros.launch.testing.lookup:NoMatchingProcessException",
        "resolveProcesses": "kit.ros.launch.testing.lookup:resolve_processes",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
