"""rclpy.node of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.exceptions import NodeNameNonExistentError
from kit.ros.node.node import HIDDEN_NODE_PREFIX, Node

__all__ = ["HIDDEN_NODE_PREFIX", "Node", "NodeNameNonExistentError"]
