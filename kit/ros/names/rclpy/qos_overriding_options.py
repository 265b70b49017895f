"""rclpy.qos_overriding_options of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.node.qos import QoSPolicyKind
from kit.ros.node.qos_overrides import (
    InvalidQosOverridesError,
    QoSOverridingOptions,
    QosCallbackResult,
    QosCallbackType,
)

__all__ = [
    "InvalidQosOverridesError",
    "QoSOverridingOptions",
    "QoSPolicyKind",
    "QosCallbackResult",
    "QosCallbackType",
]
