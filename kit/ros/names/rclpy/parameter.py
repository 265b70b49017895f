"""rclpy.parameter of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.parameters.parameter import PARAMETER_SEPARATOR_STRING, Parameter, parameter_value_to_python
from kit.ros.parameters.parameter_files import get_parameter_value, parameter_dict_from_yaml_file

__all__ = [
    "PARAMETER_SEPARATOR_STRING",
    "Parameter",
    "get_parameter_value",
    "parameter_dict_from_yaml_file",
    "parameter_value_to_python",
]
