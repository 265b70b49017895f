"""launch_testing.legacy.output of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    create_output_lines_filter: Any
    create_output_lines_test: Any
    create_output_regex_test: Any
    create_output_test_from_file: Any
    get_default_filtered_patterns: Any
    get_default_filtered_prefixes: Any
    get_rmw_output_filter: Any
else:
    _LATE_NAMES = {
        "create_output_lines_filter": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "create_output_lines_test": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "create_output_regex_test": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "create_output_test_from_file": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "get_default_filtered_patterns": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "get_default_filtered_prefixes": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "get_rmw_output_filter": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
