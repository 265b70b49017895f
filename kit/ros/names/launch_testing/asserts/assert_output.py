"""launch_testing.asserts.assert_output of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.testing.asserts import (
        assert_in_stderr as _assertInStderr,
        assert_in_stdout as _assertInStdout,
        assert_in_stream as _assertDefaultStream,
        assert_in_stream as _assertInStream,
        build_text_match as build_text_match,
        remove_ansi_escape_sequences as remove_ansi_escape_sequences,
    )
    from kit.ros.launch.testing.lookup import resolve_processes as _resolveProcesses

    assertDefaultStream = _assertDefaultStream
    assertInStderr = _assertInStderr
    assertInStdout = _assertInStdout
    assertInStream = _assertInStream
    resolveProcesses = _resolveProcesses
else:
    _LATE_NAMES = {
        "assertDefaultStream": "kit.ros.launch.testing.asserts:assert_in_stream",
        "assertInStderr": "kit.ros.launch.testing.asserts:assert_in_stderr",
        "assertInStdout": "kit.ros.launch.testing.asserts:assert_in_stdout",
        "assertInStream": "kit.ros.launch.testing.asserts:assert_in_stream",
        "build_text_match": "kit.ros.launch.testing.asserts:build_text_match",
        "remove_ansi_escape_sequences": "kit.ros.launch.testing.asserts:remove_ansi_escape_sequences",
        "resolveProcesses": "kit.ros.launch.testing.lookup:resolve_processes",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
