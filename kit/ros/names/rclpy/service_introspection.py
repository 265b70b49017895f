"""rclpy.service_introspection of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.node.service_introspection import ServiceIntrospectionState

__all__ = ["ServiceIntrospectionState"]
