"""rclpy.node of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.exceptions import NodeNameNonExistentError
from kit.ros.late_names import import_late_name
from kit.ros.node.node import HIDDEN_NODE_PREFIX, Node

__all__ = ["HIDDEN_NODE_PREFIX", "Node", "NodeNameNonExistentError"]

if TYPE_CHECKING:
    from kit.msg.rcl_interfaces import (
        FloatingPointRange as FloatingPointRange,
        IntegerRange as IntegerRange,
        ListParameters as ListParameters,
        ListParametersResult as ListParametersResult,
        Parameter as _ParameterMsg,
        ParameterDescriptor as ParameterDescriptor,
        ParameterEvent as ParameterEvent,
        ParameterType as ParameterType,
        ParameterValue as ParameterValue,
        SetParametersResult as SetParametersResult,
    )
    from kit.ros.exceptions import (
        InvalidHandle as InvalidHandle,
        InvalidParameterTypeException as InvalidParameterTypeException,
        InvalidParameterValueException as InvalidParameterValueException,
        InvalidTopicNameException as InvalidTopicNameException,
        NotInitializedException as NotInitializedException,
        ParameterAlreadyDeclaredException as ParameterAlreadyDeclaredException,
        ParameterImmutableException as ParameterImmutableException,
        ParameterNotDeclaredException as ParameterNotDeclaredException,
        ParameterUninitializedException as ParameterUninitializedException,
    )
    from kit.ros.execution.callback_groups import (
        CallbackGroup as CallbackGroup,
        MutuallyExclusiveCallbackGroup as MutuallyExclusiveCallbackGroup,
        ReentrantCallbackGroup as ReentrantCallbackGroup,
    )
    from kit.ros.execution.client_library import get_logger as get_logger
    from kit.ros.execution.context import Context as Context, get_default_context as get_default_context
    from kit.ros.execution.executors import Executor as Executor
    from kit.ros.graph.naming import (
        expand_topic_name as expand_topic_name,
        validate_full_topic_name as validate_full_topic_name,
        validate_namespace as validate_namespace,
        validate_node_name as validate_node_name,
        validate_parameter_name as validate_parameter_name,
        validate_topic_name as validate_topic_name,
    )
    from kit.ros.log import RcutilsLogger as RcutilsLogger
    from kit.ros.node.client import Client as Client
    from kit.ros.node.clock import Clock as Clock, ROSClock as ROSClock
    from kit.ros.node.endpoint import TopicEndpointInfo as TopicEndpointInfo
    from kit.ros.node.events import (
        PublisherEventCallbacks as PublisherEventCallbacks,
        SubscriptionEventCallbacks as SubscriptionEventCallbacks,
    )
    from kit.ros.node.publisher import Publisher as Publisher
    from kit.ros.node.qos import (
        QoSProfile as QoSProfile,
        qos_profile_parameter_events as qos_profile_parameter_events,
        qos_profile_services_default as qos_profile_services_default,
    )
    from kit.ros.node.qos_overrides import QoSOverridingOptions as QoSOverridingOptions
    from kit.ros.node.service import Service as Service
    from kit.ros.node.subscription import MessageInfo as MessageInfo, Subscription as Subscription
    from kit.ros.node.time import S_TO_NS as S_TO_NS
    from kit.ros.node.timer import Rate as Rate, Timer as Timer, TimerInfo as TimerInfo
    from kit.ros.node.waitable import Waitable as Waitable, WaitableGuardCondition as _GuardCondition
    from kit.ros.parameters.parameter import (
        PARAMETER_SEPARATOR_STRING as PARAMETER_SEPARATOR_STRING,
        Parameter as Parameter,
    )
    from kit.ros.parameters.parameter_services import ParameterServices as _ParameterService
    from kit.ros.type_support import (
        AllowableParameterValue as AllowableParameterValue,
        AllowableParameterValueT as AllowableParameterValueT,
        MsgT as MsgT,
        MsgT as MsgType,
        Srv as Srv,
        SrvEventT as SrvEventT,
        SrvRequestT as SrvRequestT,
        SrvRequestT as SrvTypeRequest,
        SrvResponseT as SrvResponseT,
        SrvResponseT as SrvTypeResponse,
        SrvT as SrvType,
        check_is_valid_msg_type as check_is_valid_msg_type,
        check_is_valid_srv_type as check_is_valid_srv_type,
    )

    GuardCondition = _GuardCondition
    ParameterMsg = _ParameterMsg
    ParameterService = _ParameterService
    LoggingService: Any
    TimeSource: Any
    TypeDescriptionService: Any
else:
    _LATE_NAMES = {
        "AllowableParameterValue": "kit.ros.type_support:AllowableParameterValue",
        "AllowableParameterValueT": "kit.ros.type_support:AllowableParameterValueT",
        "CallbackGroup": "kit.ros.execution.callback_groups:CallbackGroup",
        "Client": "kit.ros.node.client:Client",
        "Clock": "kit.ros.node.clock:Clock",
        "Context": "kit.ros.execution.context:Context",
        "Executor": "kit.ros.execution.executors:Executor",
        "FloatingPointRange": "kit.msg.rcl_interfaces:FloatingPointRange",
        "GuardCondition": "kit.ros.node.waitable:WaitableGuardCondition",
        "IntegerRange": "kit.msg.rcl_interfaces:IntegerRange",
        "InvalidHandle": "kit.ros.exceptions:InvalidHandle",
        "InvalidParameterTypeException": "kit.ros.exceptions:InvalidParameterTypeException",
        "InvalidParameterValueException": "kit.ros.exceptions:InvalidParameterValueException",
        "InvalidTopicNameException": "kit.ros.exceptions:InvalidTopicNameException",
        "ListParameters": "kit.msg.rcl_interfaces:ListParameters",
        "ListParametersResult": "kit.msg.rcl_interfaces:ListParametersResult",
        "LoggingService": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "MessageInfo": "kit.ros.node.subscription:MessageInfo",
        "MsgT": "kit.ros.type_support:MsgT",
        "MsgType": "kit.ros.type_support:MsgT",
        "MutuallyExclusiveCallbackGroup": "kit.ros.execution.callback_groups:MutuallyExclusiveCallbackGroup",
        "NotInitializedException": "kit.ros.exceptions:NotInitializedException",
        "PARAMETER_SEPARATOR_STRING": "kit.ros.parameters.parameter:PARAMETER_SEPARATOR_STRING",
        "Parameter": "kit.ros.parameters.parameter:Parameter",
        "ParameterAlreadyDeclaredException": "kit.ros.exceptions:ParameterAlreadyDeclaredException",
        "ParameterDescriptor": "kit.msg.rcl_interfaces:ParameterDescriptor",
        "ParameterEvent": "kit.msg.rcl_interfaces:ParameterEvent",
        "ParameterImmutableException": "kit.ros.exceptions:ParameterImmutableException",
        "ParameterMsg": "kit.msg.rcl_interfaces:Parameter",
        "ParameterNotDeclaredException": "kit.ros.exceptions:ParameterNotDeclaredException",
        "ParameterService": "kit.ros.parameters.parameter_services:ParameterServices",
        "ParameterType": "kit.msg.rcl_interfaces:ParameterType",
        "ParameterUninitializedException": "kit.ros.exceptions:ParameterUninitializedException",
        "ParameterValue": "kit.msg.rcl_interfaces:ParameterValue",
        "Publisher": "kit.ros.node.publisher:Publisher",
        "PublisherEventCallbacks": "kit.ros.node.events:PublisherEventCallbacks",
        "QoSOverridingOptions": "kit.ros.node.qos_overrides:QoSOverridingOptions",
        "QoSProfile": "kit.ros.node.qos:QoSProfile",
        "ROSClock": "kit.ros.node.clock:ROSClock",
        "Rate": "kit.ros.node.timer:Rate",
        "RcutilsLogger": "kit.ros.log:RcutilsLogger",
        "ReentrantCallbackGroup": "kit.ros.execution.callback_groups:ReentrantCallbackGroup",
        "S_TO_NS": "kit.ros.node.time:S_TO_NS",
        "Service": "kit.ros.node.service:Service",
        "SetParametersResult": "kit.msg.rcl_interfaces:SetParametersResult",
        "Srv": "kit.ros.type_support:Srv",
        "SrvEventT": "kit.ros.type_support:SrvEventT",
        "SrvRequestT": "kit.ros.type_support:SrvRequestT",
        "SrvResponseT": "kit.ros.type_support:SrvResponseT",
        "SrvType": "kit.ros.type_support:SrvT",
        "SrvTypeRequest": "kit.ros.type_support:SrvRequestT",
        "SrvTypeResponse": "kit.ros.type_support:SrvResponseT",
        "Subscription": "kit.ros.node.subscription:Subscription",
        "SubscriptionEventCallbacks": "kit.ros.node.events:SubscriptionEventCallbacks",
        "TimeSource": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "Timer": "kit.ros.node.timer:Timer",
        "TimerInfo": "kit.ros.node.timer:TimerInfo",
        "TopicEndpointInfo": "kit.ros.node.endpoint:TopicEndpointInfo",
        "TypeDescriptionService": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "Waitable": "kit.ros.node.waitable:Waitable",
        "check_is_valid_msg_type": "kit.ros.type_support:check_is_valid_msg_type",
        "check_is_valid_srv_type": "kit.ros.type_support:check_is_valid_srv_type",
        "expand_topic_name": "kit.ros.graph.naming:expand_topic_name",
        "get_default_context": "kit.ros.execution.context:get_default_context",
        "get_logger": "kit.ros.execution.client_library:get_logger",
        "qos_profile_parameter_events": "kit.ros.node.qos:qos_profile_parameter_events",
        "qos_profile_services_default": "kit.ros.node.qos:qos_profile_services_default",
        "validate_full_topic_name": "kit.ros.graph.naming:validate_full_topic_name",
        "validate_namespace": "kit.ros.graph.naming:validate_namespace",
        "validate_node_name": "kit.ros.graph.naming:validate_node_name",
        "validate_parameter_name": "kit.ros.graph.naming:validate_parameter_name",
        "validate_topic_name": "kit.ros.graph.naming:validate_topic_name",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
