"""rclpy.parameter_client of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name
from kit.ros.parameters.parameter_client import AsyncParameterClient

__all__ = ["AsyncParameterClient"]

if TYPE_CHECKING:
    from kit.msg.rcl_interfaces import (
        DescribeParameters as DescribeParameters,
        GetParameterTypes as GetParameterTypes,
        GetParameters as GetParameters,
        ListParameters as ListParameters,
        Parameter as _ParameterMsg,
        ParameterEvent as ParameterEvent,
        SetParameters as SetParameters,
        SetParametersAtomically as SetParametersAtomically,
    )
    from kit.ros.execution.callback_groups import CallbackGroup as CallbackGroup
    from kit.ros.execution.task import Future as Future
    from kit.ros.node.events import SubscriptionEventCallbacks as SubscriptionEventCallbacks
    from kit.ros.node.node import Node as Node
    from kit.ros.node.qos import (
        QoSProfile as QoSProfile,
        qos_profile_parameter_events as qos_profile_parameter_events,
        qos_profile_services_default as qos_profile_services_default,
    )
    from kit.ros.node.qos_overrides import QoSOverridingOptions as QoSOverridingOptions
    from kit.ros.node.subscription import MessageInfo as MessageInfo, Subscription as Subscription
    from kit.ros.parameters.parameter import Parameter as Parameter
    from kit.ros.parameters.parameter_files import parameter_dict_from_yaml_file as parameter_dict_from_yaml_file

    ParameterMsg = _ParameterMsg
else:
    _LATE_NAMES = {
        "CallbackGroup": "kit.ros.execution.callback_groups:CallbackGroup",
        "DescribeParameters": "kit.msg.rcl_interfaces:DescribeParameters",
        "Future": "kit.ros.execution.task:Future",
        "GetParameterTypes": "kit.msg.rcl_interfaces:GetParameterTypes",
        "GetParameters": "kit.msg.rcl_interfaces:GetParameters",
        "ListParameters": "kit.msg.rcl_interfaces:ListParameters",
        "MessageInfo": "kit.ros.node.subscription:MessageInfo",
        "Node": "kit.ros.node.node:Node",
        "Parameter": "kit.ros.parameters.parameter:Parameter",
        "ParameterEvent": "kit.msg.rcl_interfaces:ParameterEvent",
        "ParameterMsg": "kit.msg.rcl_interfaces:Parameter",
        "QoSOverridingOptions": "kit.ros.node.qos_overrides:QoSOverridingOptions",
        "QoSProfile": "kit.ros.node.qos:QoSProfile",
        "SetParameters": "kit.msg.rcl_interfaces:SetParameters",
        "SetParametersAtomically": "kit.msg.rcl_interfaces:SetParametersAtomically",
        "Subscription": "kit.ros.node.subscription:Subscription",
        "SubscriptionEventCallbacks": "kit.ros.node.events:SubscriptionEventCallbacks",
        "parameter_dict_from_yaml_file": "kit.ros.parameters.parameter_files:parameter_dict_from_yaml_file",
        "qos_profile_parameter_events": "kit.ros.node.qos:qos_profile_parameter_events",
        "qos_profile_services_default": "kit.ros.node.qos:qos_profile_services_default",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
