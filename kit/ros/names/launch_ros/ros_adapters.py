"""launch_ros.ros_adapters of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.execution.executors import SingleThreadedExecutor as SingleThreadedExecutor
    ROSAdapter: Any
    get_ros_adapter: Any
    get_ros_node: Any
else:
    _LATE_NAMES = {
        "ROSAdapter": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "SingleThreadedExecutor": "kit.ros.execution.executors:SingleThreadedExecutor",
        "get_ros_adapter": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "get_ros_node": "!launch's own process, in whose place `kit launch FILE` runs launch files",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
