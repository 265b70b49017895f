"""rclpy.qos of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name
from kit.ros.node.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    InvalidQoSProfileException,
    LivelinessPolicy,
    QoSCompatibility,
    QoSDurabilityPolicy,
    QoSHistoryPolicy,
    QoSLivelinessPolicy,
    QoSPolicyKind,
    QoSPresetProfiles,
    QoSProfile,
    QoSReliabilityPolicy,
    ReliabilityPolicy,
    qos_check_compatible,
    qos_profile_action_status_default,
    qos_profile_best_available,
    qos_profile_default,
    qos_profile_parameter_events,
    qos_profile_parameters,
    qos_profile_sensor_data,
    qos_profile_services_default,
    qos_profile_system_default,
    qos_profile_unknown,
)

__all__ = [
    "DurabilityPolicy",
    "HistoryPolicy",
    "InvalidQoSProfileException",
    "LivelinessPolicy",
    "QoSCompatibility",
    "QoSDurabilityPolicy",
    "QoSHistoryPolicy",
    "QoSLivelinessPolicy",
    "QoSPolicyKind",
    "QoSPresetProfiles",
    "QoSProfile",
    "QoSReliabilityPolicy",
    "ReliabilityPolicy",
    "qos_check_compatible",
    "qos_profile_action_status_default",
    "qos_profile_best_available",
    "qos_profile_default",
    "qos_profile_parameter_events",
    "qos_profile_parameters",
    "qos_profile_sensor_data",
    "qos_profile_services_default",
    "qos_profile_system_default",
    "qos_profile_unknown",
]

if TYPE_CHECKING:
    from enum import Enum as Enum, IntEnum as IntEnum
    from kit.ros.node.time import Duration as Duration
    DeadlineBestAvailable: Any
    LivelinessLeaseDurationeBestAvailable: Any
    QoSPolicyEnum: Any
    qos_policy_name_from_kind: Any
else:
    _LATE_NAMES = {
        "DeadlineBestAvailable": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "Duration": "kit.ros.node.time:Duration",
        "Enum": "enum:Enum",
        "IntEnum": "enum:IntEnum",
        "LivelinessLeaseDurationeBestAvailable": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "QoSPolicyEnum": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "qos_policy_name_from_kind": "!rclpy's library in C, in whose place the kit has a graph of its own",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
