"""launch.launch_description_sources.python_launch_file_utilities of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from importlib.machinery import SourceFileLoader as SourceFileLoader
    from importlib.util import module_from_spec as module_from_spec, spec_from_loader as spec_from_loader
    from kit.ros.launch.context import LaunchError as _InvalidPythonLaunchFileError
    from kit.ros.launch.entity import LaunchDescription as LaunchDescription

    InvalidPythonLaunchFileError = _InvalidPythonLaunchFileError
    get_launch_description_from_python_launch_file: Any
    load_python_launch_file_as_module: Any
else:
    _LATE_NAMES = {
        "InvalidPythonLaunchFileError": "kit.ros.launch.context:LaunchError",
        "LaunchDescription": "kit.ros.launch.entity:LaunchDescription",
        "SourceFileLoader": "importlib.machinery:SourceFileLoader",
        "get_launch_description_from_python_launch_file": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "load_python_launch_file_as_module": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "module_from_spec": "importlib.util:module_from_spec",
        "spec_from_loader": "importlib.util:spec_from_loader",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
