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
        "create_output_lines_filter": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
        "create_output_lines_test": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
        "create_output_regex_test": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
        "create_output_test_from_file": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
        "get_default_filtered_patterns": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
        "get_default_filtered_prefixes": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
        "get_rmw_output_filter": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
