"""launch.utilities.class_tools_impl of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.normalization import (
        is_a as is_a,
        is_a as _isclassinstance,
        is_a_subclass as is_a_subclass,
    )

    isclassinstance = _isclassinstance
else:
    _LATE_NAMES = {
        "is_a": "kit.ros.launch.normalization:is_a",
        "is_a_subclass": "kit.ros.launch.normalization:is_a_subclass",
        "isclassinstance": "kit.ros.launch.normalization:is_a",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
