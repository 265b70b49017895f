"""launch_testing.tools.text of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.testing.asserts import (
        build_text_match as build_text_match,
        normalize_lineseps as normalize_lineseps,
    )
    build_line_match: Any
else:
    _LATE_NAMES = {
        "build_line_match": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
        "build_text_match": "kit.ros.launch.testing.asserts:build_text_match",
        "normalize_lineseps": "kit.ros.launch.testing.asserts:normalize_lineseps",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
