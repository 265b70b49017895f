"""launch.launch_description_sources.any_launch_file_utilities of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.context import LaunchError as _InvalidLaunchFileError
    from kit.ros.launch.entity import LaunchDescription as LaunchDescription

    InvalidLaunchFileError = _InvalidLaunchFileError
    Parser: Any
    get_launch_description_from_any_launch_file: Any
    get_launch_description_from_frontend_launch_file: Any
    get_launch_description_from_python_launch_file: Any
else:
    _LATE_NAMES = {
        "InvalidLaunchFileError": "kit.ros.launch.context:LaunchError",
        "LaunchDescription": "kit.ros.launch.entity:LaunchDescription",
        "Parser": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "get_launch_description_from_any_launch_file": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "get_launch_description_from_frontend_launch_file": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "get_launch_description_from_python_launch_file": "!launch's own process, in whose place `kit launch FILE` runs launch files",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
