"""launch_ros.parameter_descriptions of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.launch.parameters import Parameter, ParameterFile, ParameterValue

__all__ = ["Parameter", "ParameterFile", "ParameterValue"]
