"""launch_ros.utilities.track_node_names of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.context import LaunchContext as LaunchContext
    add_node_name: Any
    get_node_name_count: Any
else:
    _LATE_NAMES = {
        "LaunchContext": "kit.ros.launch.context:LaunchContext",
        "add_node_name": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "get_node_name_count": "!launch's own process, in whose place `kit launch FILE` runs launch files",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
