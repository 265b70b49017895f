"""launch_ros.events.lifecycle.lifecycle_node_matchers of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.events import matches_node_name as matches_node_name
    from kit.ros.launch.processes import LifecycleNode as LifecycleNode
else:
    _LATE_NAMES = {
        "LifecycleNode": "kit.ros.launch.processes:LifecycleNode",
        "matches_node_name": "kit.ros.launch.events:matches_node_name",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
