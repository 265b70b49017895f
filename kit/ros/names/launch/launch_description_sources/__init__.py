"""launch.launch_description_sources of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name
from kit.ros.launch.description_sources import (
    LaunchDescriptionSource as AnyLaunchDescriptionSource,
    LaunchDescriptionSource as FrontendLaunchDescriptionSource,
    LaunchDescriptionSource as PythonLaunchDescriptionSource,
)

__all__ = ["AnyLaunchDescriptionSource", "FrontendLaunchDescriptionSource", "PythonLaunchDescriptionSource"]

if TYPE_CHECKING:
    from kit.ros.launch.context import (
        LaunchError as _InvalidFrontendLaunchFileError,
        LaunchError as _InvalidLaunchFileError,
        LaunchError as _InvalidPythonLaunchFileError,
    )

    InvalidFrontendLaunchFileError = _InvalidFrontendLaunchFileError
    InvalidLaunchFileError = _InvalidLaunchFileError
    InvalidPythonLaunchFileError = _InvalidPythonLaunchFileError
    get_launch_description_from_any_launch_file: Any
    get_launch_description_from_frontend_launch_file: Any
    get_launch_description_from_python_launch_file: Any
    load_python_launch_file_as_module: Any
else:
    _LATE_NAMES = {
        "InvalidFrontendLaunchFileError": "kit.ros.launch.context:LaunchError",
        "InvalidLaunchFileError": "kit.ros.launch.context:LaunchError",
        "InvalidPythonLaunchFileError": "kit.ros.launch.context:LaunchError",
        "get_launch_description_from_any_launch_file": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "get_launch_description_from_frontend_launch_file": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "get_launch_description_from_python_launch_file": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "load_python_launch_file_as_module": "!launch's own process, in whose place `kit launch FILE` runs launch files",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
