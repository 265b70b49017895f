"""launch_testing.asserts.assert_sequential_output of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from contextlib import contextmanager as contextmanager
    from kit.ros.launch.testing.asserts import (
        SequentialTextChecker as SequentialTextChecker,
        assert_sequential_stdout as _assertSequentialStdout,
    )
    from kit.ros.launch.testing.lookup import resolve_processes as _resolveProcesses

    assertSequentialStdout = _assertSequentialStdout
    resolveProcesses = _resolveProcesses
else:
    _LATE_NAMES = {
        "SequentialTextChecker": "kit.ros.launch.testing.asserts:SequentialTextChecker",
        "assertSequentialStdout": "kit.ros.launch.testing.asserts:assert_sequential_stdout",
        "contextmanager": "contextlib:contextmanager",
        "resolveProcesses": "kit.ros.launch.testing.lookup:resolve_processes",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
