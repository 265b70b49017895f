"""rclpy.qos_overriding_options of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name
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

if TYPE_CHECKING:
    from kit.msg.rcl_interfaces import (
        ParameterDescriptor as ParameterDescriptor,
        SetParametersResult as SetParametersResult,
    )
    from kit.ros.exceptions import ParameterAlreadyDeclaredException as ParameterAlreadyDeclaredException
    from kit.ros.node.node import Node as Node
    from kit.ros.node.publisher import Publisher as Publisher
    from kit.ros.node.qos import (
        QoSDurabilityPolicy as QoSDurabilityPolicy,
        QoSHistoryPolicy as QoSHistoryPolicy,
        QoSLivelinessPolicy as QoSLivelinessPolicy,
        QoSProfile as QoSProfile,
        QoSReliabilityPolicy as QoSReliabilityPolicy,
    )
    from kit.ros.node.subscription import Subscription as Subscription
    from kit.ros.node.time import Duration as Duration
    from kit.ros.parameters.parameter import Parameter as Parameter
    QoSProfileAttributes: Any
else:
    _LATE_NAMES = {
        "Duration": "kit.ros.node.time:Duration",
        "Node": "kit.ros.node.node:Node",
        "Parameter": "kit.ros.parameters.parameter:Parameter",
        "ParameterAlreadyDeclaredException": "kit.ros.exceptions:ParameterAlreadyDeclaredException",
        "ParameterDescriptor": "kit.msg.rcl_interfaces:ParameterDescriptor",
        "Publisher": "kit.ros.node.publisher:Publisher",
        "QoSDurabilityPolicy": "kit.ros.node.qos:QoSDurabilityPolicy",
        "QoSHistoryPolicy": "kit.ros.node.qos:QoSHistoryPolicy",
        "QoSLivelinessPolicy": "kit.ros.node.qos:QoSLivelinessPolicy",
        "QoSProfile": "kit.ros.node.qos:QoSProfile",
        "QoSProfileAttributes": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "QoSReliabilityPolicy": "kit.ros.node.qos:QoSReliabilityPolicy",
        "SetParametersResult": "kit.msg.rcl_interfaces:SetParametersResult",
        "Subscription": "kit.ros.node.subscription:Subscription",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
