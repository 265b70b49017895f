"""launch_ros.utilities.plugin_support of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    PluginException: Any
    Version: Any
    get_upper_bound_caret_version: Any
    satisfies_version: Any
else:
    _LATE_NAMES = {
        "PluginException": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "Version": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "get_upper_bound_caret_version": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "satisfies_version": "!launch's own process, in whose place `kit launch FILE` runs launch files",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
