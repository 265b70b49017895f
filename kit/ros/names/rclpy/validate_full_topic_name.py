"""rclpy.validate_full_topic_name of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.graph.naming import validate_full_topic_name
from kit.ros.late_names import import_late_name

__all__ = ["validate_full_topic_name"]

if TYPE_CHECKING:
    from kit.ros.exceptions import (
        InvalidServiceNameException as InvalidServiceNameException,
        InvalidTopicNameException as InvalidTopicNameException,
    )
else:
    _LATE_NAMES = {
        "InvalidServiceNameException": "kit.ros.exceptions:InvalidServiceNameException",
        "InvalidTopicNameException": "kit.ros.exceptions:InvalidTopicNameException",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
