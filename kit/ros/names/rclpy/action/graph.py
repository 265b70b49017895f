"""rclpy.action.graph of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.action.graph import (
    get_action_client_names_and_types_by_node,
    get_action_names_and_types,
    get_action_server_names_and_types_by_node,
)
from kit.ros.late_names import import_late_name

__all__ = [
    "get_action_client_names_and_types_by_node",
    "get_action_names_and_types",
    "get_action_server_names_and_types_by_node",
]

if TYPE_CHECKING:
    from kit.ros.node.node import Node as Node
else:
    _LATE_NAMES = {
        "Node": "kit.ros.node.node:Node",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
