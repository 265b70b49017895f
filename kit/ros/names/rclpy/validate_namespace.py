"""rclpy.validate_namespace of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.graph.naming import validate_namespace
from kit.ros.late_names import import_late_name

__all__ = ["validate_namespace"]

if TYPE_CHECKING:
    from kit.ros.exceptions import InvalidNamespaceException as InvalidNamespaceException
else:
    _LATE_NAMES = {
        "InvalidNamespaceException": "kit.ros.exceptions:InvalidNamespaceException",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
