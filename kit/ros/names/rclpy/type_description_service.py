"""rclpy.type_description_service of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.msg.rcl_interfaces import ParameterDescriptor as ParameterDescriptor, ParameterType as ParameterType
    from kit.msg.type_description_interfaces import GetTypeDescription as GetTypeDescription
    from kit.ros.constants import START_TYPE_DESCRIPTION_SERVICE_PARAM as START_TYPE_DESCRIPTION_SERVICE_PARAM
    from kit.ros.graph.naming import TOPIC_SEPARATOR_STRING as TOPIC_SEPARATOR_STRING
    from kit.ros.node.node import Node as Node
    from kit.ros.node.qos import qos_profile_services_default as qos_profile_services_default
    from kit.ros.node.service import Service as Service
    from kit.ros.parameters.parameter import Parameter as Parameter
    from kit.ros.type_support import check_is_valid_srv_type as check_is_valid_srv_type
    TypeDescriptionService: Any
else:
    _LATE_NAMES = {
        "GetTypeDescription": "kit.msg.type_description_interfaces:GetTypeDescription",
        "Node": "kit.ros.node.node:Node",
        "Parameter": "kit.ros.parameters.parameter:Parameter",
        "ParameterDescriptor": "kit.msg.rcl_interfaces:ParameterDescriptor",
        "ParameterType": "kit.msg.rcl_interfaces:ParameterType",
        "START_TYPE_DESCRIPTION_SERVICE_PARAM": "kit.ros.constants:START_TYPE_DESCRIPTION_SERVICE_PARAM",
        "Service": "kit.ros.node.service:Service",
        "TOPIC_SEPARATOR_STRING": "kit.ros.graph.naming:TOPIC_SEPARATOR_STRING",
        "TypeDescriptionService": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "check_is_valid_srv_type": "kit.ros.type_support:check_is_valid_srv_type",
        "qos_profile_services_default": "kit.ros.node.qos:qos_profile_services_default",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
