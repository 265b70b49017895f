"""rclpy.topic_or_service_is_hidden of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.graph.naming import topic_or_service_is_hidden
from kit.ros.late_names import import_late_name

__all__ = ["topic_or_service_is_hidden"]

if TYPE_CHECKING:
    from kit.ros.constants import HIDDEN_TOPIC_PREFIX as HIDDEN_TOPIC_PREFIX
else:
    _LATE_NAMES = {
        "HIDDEN_TOPIC_PREFIX": "kit.ros.constants:HIDDEN_TOPIC_PREFIX",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
