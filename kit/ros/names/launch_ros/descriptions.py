from kit.ros.launch.parameters import Parameter, ParameterFile, ParameterValue
from kit.ros.launch.processes import ComposableNode

__all__ = ["ComposableNode", "Parameter", "ParameterFile", "ParameterValue"]
