"""launch_testing.asserts of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.testing import (
        EXIT_OK as EXIT_OK,
        EXIT_SIGINT as EXIT_SIGINT,
        EXIT_SIGKILL as EXIT_SIGKILL,
        EXIT_SIGQUIT as EXIT_SIGQUIT,
        EXIT_SIGSEGV as EXIT_SIGSEGV,
    )
    NO_CMD_ARGS: Any
    SequentialTextChecker: Any
    assertDefaultStream: Any
    assertExitCodes: Any
    assertInStderr: Any
    assertInStdout: Any
    assertInStream: Any
    assertSequentialStdout: Any
else:
    _LATE_NAMES = {
        "EXIT_OK": "kit.ros.launch.testing:EXIT_OK",
        "EXIT_SIGINT": "kit.ros.launch.testing:EXIT_SIGINT",
        "EXIT_SIGKILL": "kit.ros.launch.testing:EXIT_SIGKILL",
        "EXIT_SIGQUIT": "kit.ros.launch.testing:EXIT_SIGQUIT",
        "EXIT_SIGSEGV": "kit.ros.launch.testing:EXIT_SIGSEGV",
        "NO_CMD_ARGS": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "SequentialTextChecker": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "assertDefaultStream": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "assertExitCodes": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "assertInStderr": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "assertInStdout": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "assertInStream": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "assertSequentialStdout": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
