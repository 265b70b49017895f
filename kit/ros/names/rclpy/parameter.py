"""rclpy.parameter of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name
from kit.ros.parameters.parameter import PARAMETER_SEPARATOR_STRING, Parameter, parameter_value_to_python
from kit.ros.parameters.parameter_files import get_parameter_value, parameter_dict_from_yaml_file

__all__ = [
    "PARAMETER_SEPARATOR_STRING",
    "Parameter",
    "get_parameter_value",
    "parameter_dict_from_yaml_file",
    "parameter_value_to_python",
]

if TYPE_CHECKING:
    from enum import Enum as Enum, IntEnum as IntEnum
    from kit.msg.rcl_interfaces import (
        Parameter as _ParameterMsg,
        ParameterType as ParameterType,
        ParameterValue as ParameterValue,
    )
    from kit.ros.type_support import (
        AllowableParameterValue as AllowableParameterValue,
        AllowableParameterValueT as AllowableParameterValueT,
    )

    ParameterMsg = _ParameterMsg
else:
    _LATE_NAMES = {
        "AllowableParameterValue": "kit.ros.type_support:AllowableParameterValue",
        "AllowableParameterValueT": "kit.ros.type_support:AllowableParameterValueT",
        "Enum": "enum:Enum",
        "IntEnum": "enum:IntEnum",
        "ParameterMsg": "kit.msg.rcl_interfaces:Parameter",
        "ParameterType": "kit.msg.rcl_interfaces:ParameterType",
        "ParameterValue": "kit.msg.rcl_interfaces:ParameterValue",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
