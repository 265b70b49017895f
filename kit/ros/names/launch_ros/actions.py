from kit.ros.launch.processes import Node, PushRosNamespace, SetParameter, SetRemap

__all__ = ["Node", "PushRosNamespace", "SetParameter", "SetRemap"]
