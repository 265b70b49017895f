"""rclpy.logging_service of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.msg.rcl_interfaces import (
        GetLoggerLevels as GetLoggerLevels,
        LoggerLevel as LoggerLevel,
        SetLoggerLevels as SetLoggerLevels,
        SetLoggerLevelsResult as SetLoggerLevelsResult,
    )
    from kit.ros.graph.naming import TOPIC_SEPARATOR_STRING as TOPIC_SEPARATOR_STRING
    from kit.ros.log import LoggingSeverity as LoggingSeverity
    from kit.ros.node.node import Node as Node
    from kit.ros.node.qos import qos_profile_services_default as qos_profile_services_default
    LoggingService: Any
else:
    _LATE_NAMES = {
        "GetLoggerLevels": "kit.msg.rcl_interfaces:GetLoggerLevels",
        "LoggerLevel": "kit.msg.rcl_interfaces:LoggerLevel",
        "LoggingService": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "LoggingSeverity": "kit.ros.log:LoggingSeverity",
        "Node": "kit.ros.node.node:Node",
        "SetLoggerLevels": "kit.msg.rcl_interfaces:SetLoggerLevels",
        "SetLoggerLevelsResult": "kit.msg.rcl_interfaces:SetLoggerLevelsResult",
        "TOPIC_SEPARATOR_STRING": "kit.ros.graph.naming:TOPIC_SEPARATOR_STRING",
        "qos_profile_services_default": "kit.ros.node.qos:qos_profile_services_default",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
