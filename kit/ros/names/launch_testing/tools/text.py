"""launch_testing.tools.text of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    build_line_match: Any
    build_text_match: Any
    normalize_lineseps: Any
else:
    _LATE_NAMES = {
        "build_line_match": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "build_text_match": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "normalize_lineseps": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
