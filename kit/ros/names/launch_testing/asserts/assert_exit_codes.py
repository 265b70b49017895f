"""launch_testing.asserts.assert_exit_codes of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.testing.asserts import assert_exit_codes as _assertExitCodes
    from kit.ros.launch.testing.lookup import resolve_processes as _resolveProcesses
    from kit.ros.launch.testing.marks import (
        EXIT_FORCED as EXIT_FORCED,
        EXIT_OK as EXIT_OK,
        EXIT_SIGINT as EXIT_SIGINT,
        EXIT_SIGKILL as EXIT_SIGKILL,
        EXIT_SIGQUIT as EXIT_SIGQUIT,
        EXIT_SIGSEGV as EXIT_SIGSEGV,
    )

    assertExitCodes = _assertExitCodes
    resolveProcesses = _resolveProcesses
else:
    _LATE_NAMES = {
        "EXIT_FORCED": "kit.ros.launch.testing.marks:EXIT_FORCED",
        "EXIT_OK": "kit.ros.launch.testing.marks:EXIT_OK",
        "EXIT_SIGINT": "kit.ros.launch.testing.marks:EXIT_SIGINT",
        "EXIT_SIGKILL": "kit.ros.launch.testing.marks:EXIT_SIGKILL",
        "EXIT_SIGQUIT": "kit.ros.launch.testing.marks:EXIT_SIGQUIT",
        "EXIT_SIGSEGV": "kit.ros.launch.testing.marks:EXIT_SIGSEGV",
        "assertExitCodes": "kit.ros.launch.testing.asserts:assert_exit_codes",
        "resolveProcesses": "kit.ros.launch.testing.lookup:resolve_processes",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
