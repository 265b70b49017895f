from kit.ros.launch.composable_nodes import ComposableNode
from kit.ros.launch.parameters import Parameter, ParameterFile, ParameterValue

__all__ = ["ComposableNode", "Parameter", "ParameterFile", "ParameterValue"]
