"""launch.utilities.ensure_argument_type_impl of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.normalization import ensure_argument_type as ensure_argument_type
else:
    _LATE_NAMES = {
        "ensure_argument_type": "kit.ros.launch.normalization:ensure_argument_type",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
