"""launch.launch_description_sources.frontend_launch_file_utilities of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.context import LaunchError as _InvalidFrontendLaunchFileError
    from kit.ros.launch.entity import LaunchDescription as LaunchDescription

    InvalidFrontendLaunchFileError = _InvalidFrontendLaunchFileError
    Parser: Any
    get_launch_description_from_frontend_launch_file: Any
else:
    _LATE_NAMES = {
        "InvalidFrontendLaunchFileError": "kit.ros.launch.context:LaunchError",
        "LaunchDescription": "kit.ros.launch.entity:LaunchDescription",
        "Parser": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "get_launch_description_from_frontend_launch_file": "!launch's own process, in whose place `kit launch FILE` runs launch files",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
