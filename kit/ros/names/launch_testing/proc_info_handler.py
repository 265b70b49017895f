"""launch_testing.proc_info_handler of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.events import ProcessExited as ProcessExited
    from kit.ros.launch.processes import ExecuteProcess as ExecuteProcess
    ActiveProcInfoHandler: Any
    NoMatchingProcessException: Any
    ProcInfoHandler: Any
    resolveProcesses: Any
else:
    _LATE_NAMES = {
        "ActiveProcInfoHandler": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "ExecuteProcess": "kit.ros.launch.processes:ExecuteProcess",
        "NoMatchingProcessException": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "ProcInfoHandler": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "ProcessExited": "kit.ros.launch.events:ProcessExited",
        "resolveProcesses": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
