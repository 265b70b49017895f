from kit.ros.exceptions import NodeNameNonExistentError
from kit.ros.node.node import Node

__all__ = ["Node", "NodeNameNonExistentError"]
