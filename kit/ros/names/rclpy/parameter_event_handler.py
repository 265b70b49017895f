"""rclpy.parameter_event_handler of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name
from kit.ros.parameters.parameter_client import (
    ParameterCallbackHandle,
    ParameterEventCallbackHandle,
    ParameterEventHandler,
)

__all__ = ["ParameterCallbackHandle", "ParameterEventCallbackHandle", "ParameterEventHandler"]

if TYPE_CHECKING:
    from itertools import chain as chain
    from kit.msg.rcl_interfaces import ParameterEvent as ParameterEvent
    from kit.ros.execution.callback_groups import CallbackGroup as CallbackGroup
    from kit.ros.node.events import SubscriptionEventCallbacks as SubscriptionEventCallbacks
    from kit.ros.node.node import Node as Node
    from kit.ros.node.qos import (
        QoSProfile as QoSProfile,
        qos_profile_parameter_events as qos_profile_parameter_events,
    )
    from kit.ros.node.qos_overrides import QoSOverridingOptions as QoSOverridingOptions
    from kit.ros.parameters.parameter import Parameter as Parameter
    from threading import Lock as Lock
else:
    _LATE_NAMES = {
        "CallbackGroup": "kit.ros.execution.callback_groups:CallbackGroup",
        "Lock": "threading:Lock",
        "Node": "kit.ros.node.node:Node",
        "Parameter": "kit.ros.parameters.parameter:Parameter",
        "ParameterEvent": "kit.msg.rcl_interfaces:ParameterEvent",
        "QoSOverridingOptions": "kit.ros.node.qos_overrides:QoSOverridingOptions",
        "QoSProfile": "kit.ros.node.qos:QoSProfile",
        "SubscriptionEventCallbacks": "kit.ros.node.events:SubscriptionEventCallbacks",
        "chain": "itertools:chain",
        "qos_profile_parameter_events": "kit.ros.node.qos:qos_profile_parameter_events",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
