"""rclpy.parameter_service of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.msg.rcl_interfaces import (
        DescribeParameters as DescribeParameters,
        GetParameterTypes as GetParameterTypes,
        GetParameters as GetParameters,
        ListParameters as ListParameters,
        ListParametersResult as ListParametersResult,
        SetParameters as SetParameters,
        SetParametersAtomically as SetParametersAtomically,
        SetParametersResult as SetParametersResult,
    )
    from kit.ros.exceptions import (
        ParameterNotDeclaredException as ParameterNotDeclaredException,
        ParameterUninitializedException as ParameterUninitializedException,
    )
    from kit.ros.graph.naming import TOPIC_SEPARATOR_STRING as TOPIC_SEPARATOR_STRING
    from kit.ros.node.node import Node as Node
    from kit.ros.node.qos import qos_profile_parameters as qos_profile_parameters
    from kit.ros.parameters.parameter import (
        PARAMETER_SEPARATOR_STRING as PARAMETER_SEPARATOR_STRING,
        Parameter as Parameter,
    )
    from kit.ros.parameters.parameter_services import ParameterServices as _ParameterService

    ParameterService = _ParameterService
else:
    _LATE_NAMES = {
        "DescribeParameters": "kit.msg.rcl_interfaces:DescribeParameters",
        "GetParameterTypes": "kit.msg.rcl_interfaces:GetParameterTypes",
        "GetParameters": "kit.msg.rcl_interfaces:GetParameters",
        "ListParameters": "kit.msg.rcl_interfaces:ListParameters",
        "ListParametersResult": "kit.msg.rcl_interfaces:ListParametersResult",
        "Node": "kit.ros.node.node:Node",
        "PARAMETER_SEPARATOR_STRING": "kit.ros.parameters.parameter:PARAMETER_SEPARATOR_STRING",
        "Parameter": "kit.ros.parameters.parameter:Parameter",
        "ParameterNotDeclaredException": "kit.ros.exceptions:ParameterNotDeclaredException",
        "ParameterService": "kit.ros.parameters.parameter_services:ParameterServices",
        "ParameterUninitializedException": "kit.ros.exceptions:ParameterUninitializedException",
        "SetParameters": "kit.msg.rcl_interfaces:SetParameters",
        "SetParametersAtomically": "kit.msg.rcl_interfaces:SetParametersAtomically",
        "SetParametersResult": "kit.msg.rcl_interfaces:SetParametersResult",
        "TOPIC_SEPARATOR_STRING": "kit.ros.graph.naming:TOPIC_SEPARATOR_STRING",
        "qos_profile_parameters": "kit.ros.node.qos:qos_profile_parameters",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
