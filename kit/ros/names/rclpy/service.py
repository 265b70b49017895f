"""rclpy.service of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.node.service import Service
from kit.ros.node.service_introspection import ServiceIntrospectionState

__all__ = ["Service", "ServiceIntrospectionState"]
