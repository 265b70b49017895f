from kit.ros.node.qos import QoSPolicyKind
from kit.ros.node.qos_overrides import (
    InvalidQosOverridesError,
    QosCallbackResult,
    QosCallbackType,
    QoSOverridingOptions,
)

__all__ = [
    "InvalidQosOverridesError",
    "QoSOverridingOptions",
    "QoSPolicyKind",
    "QosCallbackResult",
    "QosCallbackType",
]
