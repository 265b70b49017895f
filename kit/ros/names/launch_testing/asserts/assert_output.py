"""launch_testing.asserts.assert_output of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    assertDefaultStream: Any
    assertInStderr: Any
    assertInStdout: Any
    assertInStream: Any
    build_text_match: Any
    remove_ansi_escape_sequences: Any
    resolveProcesses: Any
else:
    _LATE_NAMES = {
        "assertDefaultStream": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "assertInStderr": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "assertInStdout": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "assertInStream": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "build_text_match": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "remove_ansi_escape_sequences": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "resolveProcesses": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
