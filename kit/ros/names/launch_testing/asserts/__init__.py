"""launch_testing.asserts of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.testing.asserts import (
        SequentialTextChecker as SequentialTextChecker,
        assert_exit_codes as _assertExitCodes,
        assert_in_stderr as _assertInStderr,
        assert_in_stdout as _assertInStdout,
        assert_in_stream as _assertDefaultStream,
        assert_in_stream as _assertInStream,
        assert_sequential_stdout as _assertSequentialStdout,
    )
    from kit.ros.launch.testing.lookup import NO_CMD_ARGS as NO_CMD_ARGS
    from kit.ros.launch.testing.marks import (
        EXIT_OK as EXIT_OK,
        EXIT_SIGINT as EXIT_SIGINT,
        EXIT_SIGKILL as EXIT_SIGKILL,
        EXIT_SIGQUIT as EXIT_SIGQUIT,
        EXIT_SIGSEGV as EXIT_SIGSEGV,
    )

    assertDefaultStream = _assertDefaultStream
    assertExitCodes = _assertExitCodes
    assertInStderr = _assertInStderr
    assertInStdout = _assertInStdout
    assertInStream = _assertInStream
    assertSequentialStdout = _assertSequentialStdout
else:
    _LATE_NAMES = {
        "EXIT_OK": "kit.ros.launch.testing.marks:EXIT_OK",
        "EXIT_SIGINT": "kit.ros.launch.testing.marks:EXIT_SIGINT",
        "EXIT_SIGKILL": "kit.ros.launch.testing.marks:EXIT_SIGKILL",
        "EXIT_SIGQUIT": "kit.ros.launch.testing.marks:EXIT_SIGQUIT",
        "EXIT_SIGSEGV": "kit.ros.launch.testing.marks:EXIT_SIGSEGV",
        "NO_CMD_ARGS": "kit.ros.launch.testing.lookup:NO_CMD_ARGS",
        "SequentialTextChecker": "kit.ros.launch.testing.asserts:SequentialTextChecker",
        "assertDefaultStream": "kit.ros.launch.testing.asserts:assert_in_stream",
        "assertExitCodes": "kit.ros.launch.testing.asserts:assert_exit_codes",
        "assertInStderr": "kit.ros.launch.testing.asserts:assert_in_stderr",
        "assertInStdout": "kit.ros.launch.testing.asserts:assert_in_stdout",
        "assertInStream": "kit.ros.launch.testing.asserts:assert_in_stream",
        "assertSequentialStdout": "kit.ros.launch.testing.asserts:assert_sequential_stdout",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
