"""launch_testing.proc_info_handler of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.events import ProcessExited as ProcessExited
    from kit.ros.launch.processes import ExecuteProcess as ExecuteProcess
    from kit.ros.launch.testing.lookup import (
        NoMatchingProcessException as NoMatchingProcessException,
        resolve_processes as _resolveProcesses,
    )
    from kit.ros.launch.testing.records import (
        ActiveProcInfoHandler as ActiveProcInfoHandler,
        ProcInfoHandler as ProcInfoHandler,
    )

    resolveProcesses = _resolveProcesses
else:
    _LATE_NAMES = {
        "ActiveProcInfoHandler": "kit.ros.launch.testing.records:ActiveProcInfoHandler",
        "ExecuteProcess": "kit.ros.launch.processes:ExecuteProcess",
        "NoMatchingProcessException": "kit.ros.launch.testing.lookup:NoMatchingProcessException",
        "ProcInfoHandler": "kit.ros.launch.testing.records:ProcInfoHandler",
        "ProcessExited": "kit.ros.launch.events:ProcessExited",
        "resolveProcesses": "kit.ros.launch.testing.lookup:resolve_processes",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
