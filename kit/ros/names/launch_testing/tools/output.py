"""launch_testing.tools.output of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.testing.asserts import (
        build_text_match as build_text_match,
        remove_ansi_escape_sequences as remove_ansi_escape_sequences,
    )
    basic_output_filter: Any
    build_line_match: Any
    expect_output: Any
    expected_output_from_file: Any
    get_default_filtered_patterns: Any
    get_default_filtered_prefixes: Any
else:
    _LATE_NAMES = {
        "basic_output_filter": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
        "build_line_match": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
        "build_text_match": "kit.ros.launch.testing.asserts:build_text_match",
        "expect_output": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
        "expected_output_from_file": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
        "get_default_filtered_patterns": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
        "get_default_filtered_prefixes": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
        "remove_ansi_escape_sequences": "kit.ros.launch.testing.asserts:remove_ansi_escape_sequences",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
