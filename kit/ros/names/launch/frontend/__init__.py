"""launch.frontend of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.context import LaunchError as _InvalidFrontendLaunchFileError
    from launch.frontend import type_utils as type_utils

    InvalidFrontendLaunchFileError = _InvalidFrontendLaunchFileError
    Entity: Any
    Parser: Any
    expose_action: Any
    expose_substitution: Any
else:
    _LATE_NAMES = {
        "Entity": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "InvalidFrontendLaunchFileError": "kit.ros.launch.context:LaunchError",
        "Parser": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "expose_action": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "expose_substitution": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "type_utils": "launch.frontend.type_utils",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
