"""rclpy.validate_node_name of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.graph.naming import validate_node_name
from kit.ros.late_names import import_late_name

__all__ = ["validate_node_name"]

if TYPE_CHECKING:
    from kit.ros.exceptions import InvalidNodeNameException as InvalidNodeNameException
else:
    _LATE_NAMES = {
        "InvalidNodeNameException": "kit.ros.exceptions:InvalidNodeNameException",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
