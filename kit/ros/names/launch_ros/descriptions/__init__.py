"""launch_ros.descriptions of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.launch.parameters import Parameter, ParameterFile, ParameterValue
from kit.ros.launch.processes import ComposableNode

__all__ = ["ComposableNode", "Parameter", "ParameterFile", "ParameterValue"]
