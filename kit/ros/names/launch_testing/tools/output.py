"""launch_testing.tools.output of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    basic_output_filter: Any
    build_line_match: Any
    build_text_match: Any
    expect_output: Any
    expected_output_from_file: Any
    get_default_filtered_patterns: Any
    get_default_filtered_prefixes: Any
    remove_ansi_escape_sequences: Any
else:
    _LATE_NAMES = {
        "basic_output_filter": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "build_line_match": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "build_text_match": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "expect_output": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "expected_output_from_file": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "get_default_filtered_patterns": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "get_default_filtered_prefixes": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "remove_ansi_escape_sequences": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
