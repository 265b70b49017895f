"""rclpy.topic_endpoint_info of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name
from kit.ros.node.endpoint import TopicEndpointInfo, TopicEndpointTypeEnum

__all__ = ["TopicEndpointInfo", "TopicEndpointTypeEnum"]

if TYPE_CHECKING:
    from enum import IntEnum as IntEnum
    from kit.ros.node.qos import (
        QoSHistoryPolicy as QoSHistoryPolicy,
        QoSPresetProfiles as QoSPresetProfiles,
        QoSProfile as QoSProfile,
    )
    TypeHash: Any
    TypeHashDictionary: Any
else:
    _LATE_NAMES = {
        "IntEnum": "enum:IntEnum",
        "QoSHistoryPolicy": "kit.ros.node.qos:QoSHistoryPolicy",
        "QoSPresetProfiles": "kit.ros.node.qos:QoSPresetProfiles",
        "QoSProfile": "kit.ros.node.qos:QoSProfile",
        "TypeHash": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "TypeHashDictionary": "!rclpy's library in C, in whose place the kit has a graph of its own",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
