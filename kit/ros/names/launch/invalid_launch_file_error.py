"""launch.invalid_launch_file_error of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.context import LaunchError as _InvalidLaunchFileError

    InvalidLaunchFileError = _InvalidLaunchFileError
else:
    _LATE_NAMES = {
        "InvalidLaunchFileError": "kit.ros.launch.context:LaunchError",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
